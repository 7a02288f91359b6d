// The reference renderer through other lenses than a pinhole.
#include <gtest/gtest.h>

#include <cmath>

#include "reference/camera/ray_map.h"
#include "reference/camera/view_rays.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

constexpr double kPi = 3.14159265358979323846;

View viewOf(LensKind kind, uint32_t width, uint32_t height, double pixelsPerUnit) {
  View view = lookAt({0.3, -0.2, -0.4}, {0.1, 0.1, 1}, width, height, 0.5);
  view.fx = view.fy = pixelsPerUnit;
  view.lens.kind = kind;
  return view;
}

// A pinhole of one pixel that looks from the eye of `view` along a direction.
View peephole(const View& view, const glm::dvec3& direction) {
  return lookAt(eyeOf(view), eyeOf(view) + direction, 1, 1, 1e-3);
}

void expectPixelsArePeepholes(const View& view) {
  const Foam foam = randomFoam(200, 3, 2, 4);
  const RenderedImages images = renderFoam(foam, view);
  const ViewRays rays(view);
  const ReferenceRenderer renderer(foam);
  uint32_t seen = 0;
  for (uint32_t i = 0; i < 40; ++i) {
    const uint32_t x = (i * 37) % view.width, y = (i * 23) % view.height;
    const auto ray = rays.ofPixel(x, y);
    if (!ray) continue;
    const Result<RenderedImages> one = renderer.render(peephole(view, ray->direction), plainOptions());
    ASSERT_TRUE(one) << one.error().message;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(images.colour.pixel(x, y)[c], one->colour.values[c], 1e-6) << x << ", " << y;
    }
    EXPECT_NEAR(*images.distance.pixel(x, y), one->distance.values[0], 1e-5) << x << ", " << y;
    seen += one->alpha.values[0] > 0.1f;
  }
  EXPECT_GT(seen, 15u);
}

TEST(ReferenceLenses, EveryPixelShowsWhatAPinholeAlongItsRayShows) {
  expectPixelsArePeepholes(viewOf(LensKind::kFisheye, 40, 40, 9));
  expectPixelsArePeepholes(viewOf(LensKind::kEquirectangular, 64, 32, 32 / kPi));
  View view = viewOf(LensKind::kKannalaBrandt, 40, 30, 12);
  view.lens.distortion = {0.05, -0.01, 0.002, 0};
  expectPixelsArePeepholes(view);
  view = viewOf(LensKind::kRadialTangential, 40, 30, 30);
  view.lens.distortion = {-0.25, 0.06, 0.001, -0.002, 0};
  expectPixelsArePeepholes(view);
  view = viewOf(LensKind::kRayMap, 8, 8, 1);
  RayMap map{8, 8, {}};
  for (int i = 0; i < 64; ++i) {
    map.directions.push_back(glm::normalize(glm::vec3(std::sin(i), std::cos(2 * i), std::sin(3 * i))));
  }
  view.lens.rays = std::make_shared<RayMap>(map);
  expectPixelsArePeepholes(view);
}

// Six pinholes with an angle of view of 90 degrees, and the same directions from longitudes and latitudes.
TEST(ReferenceLenses, TheFacesOfACubeShowAPanorama) {
  const Foam foam = randomFoam(150, 2, 1, 9);
  View panorama = viewOf(LensKind::kEquirectangular, 256, 128, 128 / kPi);
  panorama.worldFromCamera = {1, 0, 0, 0.1, 0, 1, 0, 0.2, 0, 0, 1, -0.1};
  const RenderedImages all = renderFoam(foam, panorama);
  double difference = 0;
  uint32_t compared = 0;
  const double faces[6][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1},  {-1, 0, 0, 0, 1, 0, 0, 0, -1},
                              {0, 0, 1, 0, 1, 0, -1, 0, 0}, {0, 0, -1, 0, 1, 0, 1, 0, 0},
                              {1, 0, 0, 0, 0, 1, 0, -1, 0}, {1, 0, 0, 0, 0, -1, 0, 1, 0}};
  for (const auto& rows : faces) {
    View face = lookAt(eyeOf(panorama), {0.1, 0.2, 3}, 64, 64, 1);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) face.worldFromCamera[4 * row + column] = rows[3 * row + column];
    }
    const RenderedImages images = renderFoam(foam, face);
    for (uint32_t y = 0; y < 64; y += 3) {
      for (uint32_t x = 0; x < 64; x += 3) {
        const glm::dvec3 d = directionOf(face, x, y);
        const auto column = static_cast<uint32_t>(std::atan2(d.x, d.z) * panorama.fx + panorama.cx);
        const auto row = static_cast<uint32_t>(std::asin(d.y) * panorama.fy + panorama.cy);
        for (int c = 0; c < 3; ++c) {
          difference += std::abs(double{images.colour.pixel(x, y)[c]} -
                                 all.colour.pixel(std::min(column, 255u), std::min(row, 127u))[c]);
        }
        ++compared;
      }
    }
  }
  EXPECT_LT(difference / (3 * compared), 0.03) << "half a pixel apart on the mean";
}

// Behind an orthographic camera there is nothing, and a ball that its plane cuts is seen from there on.
//
//        plane
//     __   :
//    /  \--:-- ray, t = 0 at the plane
//    \__/  :
TEST(ReferenceLenses, OrthographicRaysStartOnThePlaneOfTheCamera) {
  View view = viewOf(LensKind::kOrthographic, 9, 9, 4);
  view.worldFromCamera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  view.cx = view.cy = 4.5;
  const float density = 0.7f;
  const RenderedImages cut = renderFoam(foamOf({{{0, 0, 0.25f}, 1, density}}), view);
  for (const auto& [x, offset] : {std::pair(4u, 0.0), std::pair(6u, 0.5), std::pair(1u, 0.75)}) {
    const double chord = 0.25 + std::sqrt(1 - offset * offset);  // from z = 0
    EXPECT_NEAR(*cut.alpha.pixel(x, 4), 1 - std::exp(-density * chord), 1e-6) << x;
  }
  EXPECT_EQ(*cut.alpha.pixel(0, 0), 0) << "beside the ball";
  EXPECT_EQ(*cut.distance.pixel(0, 0), -1);
  const RenderedImages behind = renderFoam(foamOf({{{0, 0, -1.5f}, 1, density}}), view);
  EXPECT_EQ(*behind.alpha.pixel(4, 4), 0);
  const RenderedImages before = renderFoam(foamOf({{{0, 0, 5}, 1, 50}}), view);
  EXPECT_NEAR(*before.distance.pixel(4, 4), 4 + std::log(2) / 50, 1e-6);
}

TEST(ReferenceLenses, AnOrthographicViewIsThatOfAFarPinhole) {
  const Foam foam = randomFoam(200, 3, 2, 8);
  View parallel = lookAt({1, 2, -4}, {0, 0, 0}, 60, 50, 1);
  parallel.fx = parallel.fy = 20;
  parallel.lens.kind = LensKind::kOrthographic;
  const double distance = 1e6;
  View pinhole = parallel;
  pinhole.lens.kind = LensKind::kPinhole;
  pinhole.fx = pinhole.fy = 20 * distance;
  for (int row = 0; row < 3; ++row) pinhole.worldFromCamera[4 * row + 3] -= distance * forwardOf(parallel)[row];
  const RenderedImages a = renderFoam(foam, parallel), b = renderFoam(foam, pinhole);
  double squares = 0, mostDepth = 0;
  for (size_t i = 0; i < a.colour.values.size(); ++i) {
    squares += std::pow(double{a.colour.values[i]} - b.colour.values[i], 2);
  }
  for (size_t i = 0; i < a.distance.values.size(); ++i) {
    if (a.distance.values[i] > 0 && b.distance.values[i] > 0) {
      mostDepth = std::max(mostDepth, std::abs(a.distance.values[i] - (b.distance.values[i] - distance)));
    }
  }
  EXPECT_GT(-10 * std::log10(squares / double(a.colour.values.size())), 70);
  EXPECT_LT(mostDepth, 0.1) << "floats a million away";
}

TEST(ReferenceLenses, NearTestsApplyWhereTheyMeanSomething) {
  const Foam foam = foamOf({{{0, 0, 2}, 1, 3}});
  ReferenceOptions near = plainOptions(), deep = plainOptions();
  near.nearRatio = 3;  // nearer than three radii
  deep.nearDepth = 2.5;
  const auto alphaOf = [&](LensKind kind, const ReferenceOptions& options) {
    View view = viewOf(kind, 1, 1, 100);
    view.worldFromCamera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    if (kind == LensKind::kKannalaBrandt) view.lens.distortion = {0, 0, 0, 0};
    return renderFoam(foam, view, options).alpha.values[0];
  };
  for (const LensKind kind : {LensKind::kPinhole, LensKind::kRadialTangential}) {
    EXPECT_EQ(alphaOf(kind, near), 0);
    EXPECT_EQ(alphaOf(kind, deep), 0);
  }
  for (const LensKind kind : {LensKind::kFisheye, LensKind::kKannalaBrandt, LensKind::kEquirectangular}) {
    EXPECT_EQ(alphaOf(kind, near), 0);
    EXPECT_GT(alphaOf(kind, deep), 0.9);
  }
  EXPECT_GT(alphaOf(LensKind::kOrthographic, near), 0.9);
  EXPECT_GT(alphaOf(LensKind::kOrthographic, deep), 0.9);
}

TEST(ReferenceLenses, PixelsWithoutARayAreBlack) {
  const Foam foam = foamOf({{{0, 0, 0}, 5, 100, {1, 1, 1}}});
  const View view = viewOf(LensKind::kFisheye, 20, 20, 2);  // half a turn after 6.28 pixels
  const RenderedImages images = renderFoam(foam, view);
  EXPECT_GT(*images.alpha.pixel(10, 10), 0.99f);
  EXPECT_GT(*images.alpha.pixel(10, 15), 0.99f);
  EXPECT_EQ(*images.alpha.pixel(0, 0), 0);
  EXPECT_EQ(images.colour.pixel(0, 0)[1], 0);
  EXPECT_EQ(*images.distance.pixel(0, 0), -1);
  View mapless = viewOf(LensKind::kRayMap, 4, 4, 1);
  EXPECT_FALSE(ReferenceRenderer(foam).render(mapless, plainOptions()));
}

}  // namespace
}  // namespace froth
