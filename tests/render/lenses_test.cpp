// Cameras of every lens: raster and walk against each other and against the double reference.
#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/quaternion.hpp>

#include "reference/camera/ray_map.h"
#include "reference/camera/view_rays.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr uint32_t kLenses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;
constexpr VkExtent2D kLargest = {320, 200};

const Foam& lensFoam() {
  static const Foam foam = makeRandomFoam(600, 4, 2, 77);  // in [-1, 1]^3 + (0, 0, 3)
  return foam;
}

Stage& lensStage() {
  static Stage* const stage = new Stage(bakeForTest(lensFoam()), kLargest, createCheckedContext(kLenses), 0, kLenses);
  return *stage;
}

View viewOf(LensKind kind, uint32_t width, uint32_t height, double pixelsPerUnit,
            const glm::dvec3& eye = {0.6, -0.4, 0.5}) {
  View view = lookAt(eye, {0.1, 0.05, 3}, width, height, 0.5);
  view.fx = view.fy = pixelsPerUnit;
  view.lens.kind = kind;
  return view;
}

Frame drawLens(Method method, const View& view, const FrothRenderInfo& info) {
  FrothRenderInfo wanted = info;
  if (view.lens.kind != LensKind::kRayMap) return lensStage().draw(method, wanted, {view.width, view.height});
  HostImage rays = uploadRayMap(view);
  wanted.camera.lens.rayMap = sharedHost().describeInput(rays);
  const Frame frame = lensStage().draw(method, wanted, {view.width, view.height});
  sharedHost().destroyImage(rays);
  return frame;
}

// Distances where both have one.
void expectSameDistances(const Image& distance, const Image& depth) {
  uint32_t differing = 0;
  for (size_t i = 0; i < depth.values.size(); ++i) {
    const float expected = depth.values[i] < 0 ? INFINITY : depth.values[i];
    if (std::isinf(expected) != std::isinf(distance.values[i])) {
      ++differing;
    } else if (std::isfinite(expected) && std::abs(expected - distance.values[i]) > 1e-3f * (1 + expected)) {
      ++differing;
    }
  }
  EXPECT_LE(differing, 2 + depth.values.size() / 1000);
}

// `info` draws what `view` sees.
void expectAllAgree(const View& view, const FrothRenderInfo& info) {
  SCOPED_TRACE(testing::Message() << "lens " << static_cast<int>(view.lens.kind) << ", " << view.width << " x "
                                  << view.height);
  const Frame raster = drawLens(Method::kRaster, view, info), walk = drawLens(Method::kWalk, view, info);
  EXPECT_EQ(raster.status.bits, 0u);
  EXPECT_EQ(walk.status.bits, 0u);
  const RenderedImages reference = renderReference(lensFoam(), view, 1e-3);
  const double pair = psnr(raster.colour, walk.colour), first = psnr(raster.colour, reference.colour),
               second = psnr(walk.colour, reference.colour);
  std::printf(
      "[   PSNR   ] lens %d, %u x %u: raster-walk %.1f dB, raster-reference %.1f dB, walk-reference %.1f dB, %.2g "
      "over\n",
      static_cast<int>(view.lens.kind), view.width, view.height, pair, first, second,
      overTwoSteps(raster.colour, walk.colour));
  EXPECT_GE(pair, 60);
  EXPECT_LE(overTwoSteps(raster.colour, walk.colour), 1e-4);
  EXPECT_GE(first, 55);
  EXPECT_GE(second, 55);
  EXPECT_GE(psnr(raster.alpha, reference.alpha), 55);
  EXPECT_GE(psnr(raster.normal, reference.normal), 50);
  expectSameDistances(raster.distance, reference.distance);
  expectSameDistances(walk.distance, reference.distance);
  float seen = 0;
  for (const float value : reference.alpha.values) seen = std::max(seen, value);
  EXPECT_GT(seen, 0.5f) << "nothing to be seen";
}

void expectAllAgree(const View& view) { expectAllAgree(view, infoOf(view)); }

View kannalaBrandt(uint32_t width, uint32_t height) {
  View view = viewOf(LensKind::kKannalaBrandt, width, height, 0.35 * width);
  view.lens.distortion = {-0.021, 0.0088, -0.0056, 0.0008};
  view.cx += 7.25;
  return view;
}

View radialTangential(uint32_t width, uint32_t height) {
  View view = viewOf(LensKind::kRadialTangential, width, height, 0.7 * width);
  view.lens.distortion = {-0.33, 0.14, -0.0011, 0.0023, -0.031};
  view.cy -= 4.5;
  return view;
}

View panorama(uint32_t width, uint32_t height, const glm::dvec3& eye) {
  View view = viewOf(LensKind::kEquirectangular, width, height, width / (2 * kPi), eye);
  view.fy = height / kPi;
  return view;
}

// Waves of directions around the axis, none in the corners and in a hole.
View waves(uint32_t width, uint32_t height) {
  View view = viewOf(LensKind::kRayMap, width, height, 1);
  RayMap map{width, height, {}};
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const double u = (x + 0.5) / width - 0.5, v = (y + 0.5) / height - 0.5;
      const glm::vec3 direction(u + 0.05 * std::sin(20 * v), 0.7 * v + 0.05 * std::sin(25 * u), 0.8);
      const bool isHole = u * u + v * v > 0.4 || std::hypot(u - 0.1, v) < 0.06;
      map.directions.push_back(isHole ? glm::vec3(0) : 3.0f * glm::normalize(direction));
    }
  }
  view.lens.rays = std::make_shared<RayMap>(map);
  return view;
}

TEST(Lenses, RasterWalkAndReferenceAgreeForAFisheye) { expectAllAgree(viewOf(LensKind::kFisheye, 200, 200, 55)); }

TEST(Lenses, RasterWalkAndReferenceAgreeForAKannalaBrandtLens) { expectAllAgree(kannalaBrandt(240, 180)); }

TEST(Lenses, RasterWalkAndReferenceAgreeForARadialTangentialLens) { expectAllAgree(radialTangential(240, 180)); }

TEST(Lenses, RasterWalkAndReferenceAgreeForAPanoramaInsideAndOutsideTheFoam) {
  expectAllAgree(panorama(320, 160, {0.6, -0.4, 0.5}));
  expectAllAgree(panorama(320, 160, {0.1, 0.05, 2.9}));
}

TEST(Lenses, RasterWalkAndReferenceAgreeForARayMapWithHoles) {
  const View view = waves(221, 163);
  expectAllAgree(view);
  const Frame frame = drawLens(Method::kRaster, view, infoOf(view));
  EXPECT_EQ(*frame.alpha.pixel(0, 0), 0);
  EXPECT_EQ(frame.colour.pixel(0, 0)[0], 0);
  EXPECT_TRUE(std::isinf(*frame.distance.pixel(0, 0)));
  EXPECT_EQ(*frame.alpha.pixel(132, 81), 0) << "in the hole";
}

// Balls of a few pixels lie in one tile or two: a bound of rays that is 3 % too narrow loses some. The first view is
// narrow enough for blocks of tiles to have cones.
TEST(Lenses, NoTileOrBlockOfTilesLosesASmallBall) {
  Foam foam = makeRandomFoam(6000, 1, 0, 5);
  for (float& radius : foam.radii) radius *= 0.06f;
  for (float& density : foam.densities) density *= 30;
  Stage stage(bakeForTest(foam), kLargest, lensContext(), 0, kLenses);
  for (const View& view : {viewOf(LensKind::kFisheye, 320, 200, 260), panorama(320, 160, {0.1, 0.05, 2.9})}) {
    const Frame raster = stage.draw(Method::kRaster, infoOf(view), {view.width, view.height});
    const RenderedImages reference = renderReference(foam, view, 1e-3);
    float largest = 0;
    double sum = 0;
    for (size_t i = 0; i < reference.alpha.values.size(); ++i) {
      largest = std::max(largest, std::abs(raster.alpha.values[i] - reference.alpha.values[i]));
      sum += reference.alpha.values[i];
    }
    EXPECT_LT(largest, 0.02f) << static_cast<int>(view.lens.kind);
    EXPECT_GT(sum, 500);
  }
}

TEST(Lenses, SmallAndOddImagesAgreeToo) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, VkExtent2D{9, 1}, VkExtent2D{33, 65}, VkExtent2D{257, 31}}) {
    View view =
        viewOf(LensKind::kFisheye, extent.width, extent.height, 0.4 * std::max(extent.width, extent.height), {0, 0, 1});
    expectAllAgree(view);
  }
}

TEST(Lenses, JitterMovesTheImageOfAnyLens) {
  for (const LensKind kind : {LensKind::kPinhole, LensKind::kFisheye}) {
    const View view = viewOf(kind, 120, 100, 90);
    FrothRenderInfo info = infoOf(view);
    info.camera.jitter[0] = 0.375f;
    info.camera.jitter[1] = -0.25f;
    View moved = view;
    moved.cx += 0.375;
    moved.cy -= 0.25;
    expectAllAgree(moved, info);
  }
}

// A scissor inside of a viewport that does not begin at the image's corner.
TEST(Lenses, AViewportMovesALensAndAScissorCutsIt) {
  const View view = viewOf(LensKind::kFisheye, 160, 120, 70);
  FrothRenderInfo info = infoOf(view);
  const Frame whole = drawLens(Method::kRaster, view, info);
  info.camera.viewport = {20, 10, 130, 90, 0, 1};
  info.camera.scissor = {{37, 21}, {70, 50}};
  info.camera.lens.centre[0] -= 20;
  info.camera.lens.centre[1] -= 10;
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame part = drawLens(method, view, info);
    double most = 0;
    for (uint32_t y = 21; y < 71; ++y) {
      for (uint32_t x = 37; x < 107; ++x) {
        most = std::max(most, double{std::abs(part.colour.pixel(x, y)[1] - whole.colour.pixel(x, y)[1])});
      }
    }
    EXPECT_LT(most, 0.01);
  }
}

TEST(Lenses, AnOffCentreAndObliquePinholeAgrees) {
  View view = viewOf(LensKind::kPinhole, 200, 150, 170);
  view.cx = 12.5;
  view.cy = 141;
  FrothRenderInfo info = infoOf(view);
  info.camera.clipFromView[2] = 0.3f;  // an oblique near plane
  info.camera.clipFromView[6] = -0.2f;
  expectAllAgree(view, info);
}

TEST(Lenses, RasterWalkAndReferenceAgreeForParallelRays) {
  expectAllAgree(viewOf(LensKind::kOrthographic, 200, 150, 60));
  expectAllAgree(viewOf(LensKind::kOrthographic, 200, 150, 60, {0.3, 0.2, 2.8}));  // the plane cuts the foam
  expectAllAgree(viewOf(LensKind::kOrthographic, 33, 65, 30));
  expectAllAgree(viewOf(LensKind::kOrthographic, 1, 1, 2));
  View offCentre = viewOf(LensKind::kOrthographic, 150, 120, 55);
  offCentre.cx = 20.25;
  offCentre.cy = 100.5;
  offCentre.fy = 40;
  expectAllAgree(offCentre);
}

// The same image from the axes of OpenGL (x right, y up, z backward) and a viewport of negative height.
TEST(Lenses, ParallelRaysFollowTheMatrixAndTheViewport) {
  const View view = viewOf(LensKind::kOrthographic, 120, 90, 45);
  const FrothRenderInfo plain = infoOf(view);
  FrothRenderInfo turned = plain;
  FrothCamera& camera = turned.camera;
  for (int column = 0; column < 3; ++column) {
    for (const int row : {1, 2}) camera.viewFromWorld[3 * column + row] *= -1;
  }
  camera.viewport.y = 90;
  camera.viewport.height = -90;
  camera.jitter[0] = 0.25f;
  View moved = view;
  moved.cx += 0.25;
  expectAllAgree(moved, turned);
}

// An instance that is placed, turned and scaled is seen like its foam from the camera's place within it.
TEST(Lenses, ParallelRaysMeetAPlacedInstance) {
  const View view = viewOf(LensKind::kOrthographic, 120, 90, 45);
  Stage& stage = lensStage();
  FrothInstanceInfo placement{};
  placement.position[0] = 100;
  placement.rotation[1] = 0.6f;
  placement.rotation[3] = 0.8f;
  placement.scale = 2;
  stage.place(placement);
  const glm::dmat3 rotation = glm::mat3_cast(glm::dquat(0.8, 0, 0.6, 0));
  View placed = view;
  for (int column = 0; column < 4; ++column) {
    const auto& m = view.worldFromCamera;
    glm::dvec3 v = rotation * glm::dvec3(m[column], m[4 + column], m[8 + column]);
    if (column == 3) v = 2.0 * v + glm::dvec3(100, 0, 0);
    for (int row = 0; row < 3; ++row) placed.worldFromCamera[4 * row + column] = v[row];
  }
  placed.fx = placed.fy = 22.5;
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame frame = drawLens(method, placed, infoOf(placed));
    EXPECT_GE(psnr(frame.colour, renderReference(lensFoam(), view, 1e-3).colour), 55);
  }
  stage.place({});
}

TEST(Lenses, WithoutDistortionALensIsAPinhole) {
  const View pinhole = viewOf(LensKind::kPinhole, 300, 190, 260);
  View lens = pinhole;
  lens.lens.kind = LensKind::kRadialTangential;
  lens.lens.distortion = {0, 0, 0, 0};
  const Frame expected = drawLens(Method::kRaster, pinhole, infoOf(pinhole));
  const Frame found = drawLens(Method::kRaster, lens, infoOf(lens));
  EXPECT_GE(psnr(expected.colour, found.colour), 100);
  EXPECT_LE(found.status.pairs, 13 * expected.status.pairs / 10) << "cones are round";
}

TEST(Lenses, ADefaultPanoramaHoldsTheWholeSphere) {
  const View view = panorama(160, 80, {0.6, -0.4, 0.5});
  FrothRenderInfo info = infoOf(view);
  const Frame given = drawLens(Method::kRaster, view, info);
  info.camera.lens.focal[0] = info.camera.lens.focal[1] = 0;
  const Frame byDefault = drawLens(Method::kRaster, view, info);
  EXPECT_GE(psnr(given.colour, byDefault.colour), 70);
}

}  // namespace
}  // namespace froth::test
