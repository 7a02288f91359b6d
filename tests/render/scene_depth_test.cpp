// A scene's depth stops rays, and device depth comes out: every convention of depth, against the double reference.
#include <cmath>
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include "reference/camera/view_rays.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr uint32_t kWidth = 150, kHeight = 110;
constexpr double kNear = 0.1, kFar = 12;

const Foam& foam() {
  static const Foam made = makeRandomFoam(500, 4, 2, 31);  // in [-1, 1]^3 + (0, 0, 3)
  return made;
}

Stage& stage() {
  constexpr uint32_t kLenses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;
  static FrothContext* const context = createCheckedContext(kLenses);
  static Stage* const made = new Stage(bakeForTest(foam()), {kWidth, kHeight}, context, 0, kLenses);
  return *made;
}

View slantedView() { return lookAt({0.7, -0.5, 0.4}, {0.05, 0.1, 3}, kWidth, kHeight, 0.45); }

struct Convention {
  bool isReversed, isInfinite, isFlipped;
};

// `info` of the same image with another projection in depth.
FrothRenderInfo infoOf(const View& view, Convention convention) {
  FrothRenderInfo info = test::infoOf(view);
  float(&clip)[16] = info.camera.clipFromView;
  const double a = convention.isInfinite ? 1 : kFar / (kFar - kNear), b = -a * kNear;  // z = a z + b, w = z
  clip[10] = static_cast<float>(convention.isReversed ? 1 - a : a);
  clip[14] = static_cast<float>(convention.isReversed ? -b : b);
  if (convention.isFlipped) {
    for (const int y : {1, 5, 9, 13}) clip[y] = -clip[y];
    info.camera.viewport.y = info.camera.viewport.height;
    info.camera.viewport.height = -info.camera.viewport.height;
  }
  return info;
}

// Device depth of a point at distance t along a ray, by the caller's matrix.
double deviceDepth(const FrothRenderInfo& info, const View& view, const ViewRay& ray, double t) {
  const glm::dvec3 point = ray.offset + t * ray.direction;
  glm::dvec3 inView;
  for (int row = 0; row < 3; ++row) {
    const auto& m = view.worldFromCamera;
    inView[row] = m[row] * point.x + m[4 + row] * point.y + m[8 + row] * point.z;
  }
  const float(&clip)[16] = info.camera.clipFromView;
  const auto rowOf = [&](int r) {
    return clip[r] * inView.x + clip[4 + r] * inView.y + clip[8 + r] * inView.z + clip[12 + r];
  };
  const VkViewport& viewport = info.camera.viewport;
  return viewport.minDepth + rowOf(2) / rowOf(3) * (viewport.maxDepth - viewport.minDepth);
}

// The distance to a plane across the foam, slanted so that it fills a part of the image.
std::optional<double> distanceToWall(const View& view, const ViewRay& ray) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.55, 0.2, -1));
  const glm::dvec3 start = eyeOf(view) + ray.offset;
  const double t = glm::dot(normal, glm::dvec3(0, 0, 2.4) - start) / glm::dot(normal, ray.direction);
  return t > 0 && std::sin(9 * (start + t * ray.direction).y) > -0.4 ? std::optional(t) : std::nullopt;
}

struct Wall {
  Image distances;            // 1 channel; +inf: none
  std::vector<float> texels;  // as the scene's depth image holds them
};

Wall drawWall(const View& view, float nothing, const std::function<float(const ViewRay&, double)>& texelOf) {
  Wall wall{{view.width, view.height, 1, {}}, {}};
  const ViewRays rays(view);
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const std::optional<ViewRay> ray = rays.ofPixel(x, y);
      const std::optional<double> t = ray ? distanceToWall(view, *ray) : std::nullopt;
      wall.distances.values.push_back(t ? static_cast<float>(*t) : INFINITY);
      wall.texels.push_back(t ? texelOf(*ray, *t) : nothing);
    }
  }
  return wall;
}

float farEnd(const FrothRenderInfo& info, Convention convention) {
  return convention.isReversed ? info.camera.viewport.minDepth : info.camera.viewport.maxDepth;
}

void expectStopsAtWall(const View& view, FrothRenderInfo info, const Wall& wall, VkFormat format, double least) {
  Result<HostImage> sceneDepth = sharedHost().createImage(format, {view.width, view.height});
  ASSERT_TRUE(sceneDepth) << sceneDepth.error().message;
  ASSERT_TRUE(sharedHost().writeImage(*sceneDepth, wall.texels));
  info.sceneDepth = sharedHost().describeInput(*sceneDepth);
  const RenderedImages expected = renderReference(foam(), view, 1e-3, &wall.distances);
  const RenderedImages without = renderReference(foam(), view, 1e-3);
  EXPECT_LT(psnr(expected.colour, without.colour), 25) << "the wall hides next to nothing";
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame frame = stage().draw(method, info, {view.width, view.height});
    EXPECT_GE(psnr(frame.colour, expected.colour), least);
    EXPECT_GE(psnr(frame.alpha, expected.alpha), least);
    EXPECT_EQ(frame.status.bits, 0u);
  }
  sharedHost().destroyImage(*sceneDepth);
}

class SceneDepth : public testing::TestWithParam<int> {
 protected:
  static Convention convention() { return {(GetParam() & 1) != 0, (GetParam() & 2) != 0, (GetParam() & 4) != 0}; }
};

TEST_P(SceneDepth, StopsRaysInAnyConvention) {
  const View view = slantedView();
  const FrothRenderInfo info = infoOf(view, convention());
  const Wall wall = drawWall(view, farEnd(info, convention()), [&](const ViewRay& ray, double t) {
    return static_cast<float>(deviceDepth(info, view, ray, t));
  });
  expectStopsAtWall(view, info, wall, VK_FORMAT_D32_SFLOAT, 55);
}

TEST_P(SceneDepth, ComesOutAsTheProjectionMakesIt) {
  const View view = slantedView();
  FrothRenderInfo info = infoOf(view, convention());
  info.camera.viewport.minDepth = 0.25f;
  info.camera.viewport.maxDepth = 0.75f;
  const ViewRays rays(view);
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame frame = stage().draw(method, info, {view.width, view.height});
    uint32_t stopped = 0;
    for (uint32_t y = 0; y < view.height; ++y) {
      for (uint32_t x = 0; x < view.width; ++x) {
        const float t = *frame.distance.pixel(x, y);
        const float depth = *frame.depth.pixel(x, y);
        if (std::isinf(t)) {
          ASSERT_EQ(depth, farEnd(info, convention())) << x << ", " << y;
          continue;
        }
        ++stopped;
        ASSERT_NEAR(depth, deviceDepth(info, view, *rays.ofPixel(x, y), t), 2e-6) << x << ", " << y;
      }
    }
    EXPECT_GT(stopped, kWidth * kHeight / 8);
    EXPECT_LT(stopped, kWidth * kHeight);
  }
}

INSTANTIATE_TEST_SUITE_P(Conventions, SceneDepth, testing::Range(0, 8), [](const testing::TestParamInfo<int>& test) {
  return std::string(test.param & 1 ? "reversed" : "forward") + (test.param & 2 ? "_infinite" : "_finite") +
         (test.param & 4 ? "_flipped" : "_upright");
});

TEST(SceneDepthFormats, OfFewerBitsStopRaysWhereTheyRoundTo) {
  const View view = slantedView();
  const FrothRenderInfo info = infoOf(view, {.isReversed = false, .isInfinite = false, .isFlipped = false});
  const Wall wall = drawWall(
      view, 1, [&](const ViewRay& ray, double t) { return static_cast<float>(deviceDepth(info, view, ray, t)); });
  expectStopsAtWall(view, info, wall, VK_FORMAT_D32_SFLOAT_S8_UINT, 55);
  expectStopsAtWall(view, info, wall, VK_FORMAT_R32_SFLOAT, 55);
  // 1e-3 of the distance between the wall's 16-bit depths
  expectStopsAtWall(view, info, wall, VK_FORMAT_D16_UNORM, 40);
}

TEST(SceneDepthLenses, StopsParallelRays) {
  View view = slantedView();
  view.lens.kind = LensKind::kOrthographic;
  view.fx = view.fy = 0.4 * kHeight;
  const FrothRenderInfo info = test::infoOf(view);
  const Wall wall = drawWall(
      view, 1, [&](const ViewRay& ray, double t) { return static_cast<float>(deviceDepth(info, view, ray, t)); });
  expectStopsAtWall(view, info, wall, VK_FORMAT_D32_SFLOAT, 55);
}

TEST(SceneDepthLenses, IsADistanceWhereNoProjectionMakesIt) {
  View view = slantedView();
  view.lens.kind = LensKind::kFisheye;
  const Wall wall = drawWall(view, INFINITY, [&](const ViewRay&, double t) { return static_cast<float>(t); });
  expectStopsAtWall(view, test::infoOf(view), wall, VK_FORMAT_R32_SFLOAT, 55);
}

TEST(SceneDepthPlacement, IsOfTheWorldWhateverTheInstancesScale) {
  const View view = slantedView();
  const FrothRenderInfo info = infoOf(view, {.isReversed = true, .isInfinite = true, .isFlipped = false});
  const Wall wall = drawWall(
      view, 0, [&](const ViewRay& ray, double t) { return static_cast<float>(deviceDepth(info, view, ray, t)); });
  Foam half = foam();
  for (glm::vec3& site : half.sites) site *= 0.5f;
  for (float& radius : half.radii) radius *= 0.5f;
  for (float& density : half.densities) density *= 2;
  Stage scaled(bakeForTest(half), {kWidth, kHeight});
  scaled.place(placementOf({}, glm::vec4(0), 2));
  Result<HostImage> sceneDepth = sharedHost().createImage(VK_FORMAT_D32_SFLOAT, {kWidth, kHeight});
  ASSERT_TRUE(sceneDepth && sharedHost().writeImage(*sceneDepth, wall.texels));
  FrothRenderInfo stopped = info;
  stopped.sceneDepth = sharedHost().describeInput(*sceneDepth);
  const RenderedImages expected = renderReference(foam(), view, 1e-3, &wall.distances);
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    EXPECT_GE(psnr(scaled.draw(method, stopped, {kWidth, kHeight}).colour, expected.colour), 55);
  }
  sharedHost().destroyImage(*sceneDepth);
}

}  // namespace
}  // namespace froth::test
