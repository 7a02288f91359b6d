// Which instances a camera may see, against the rays of its pixels.
#include "runtime/render/placed_box.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/gtc/quaternion.hpp>

#include "host/make_struct.h"
#include "runtime/render/camera_rays.h"
#include "runtime/render/frame_block.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"
#include "tests/render/split_asset.h"

namespace froth::test {
namespace {

bool meets(const PlacedBox& box, const glm::dvec3& ray) {
  double low = 0, high = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double at = -glm::dot(box.centre, box.axes[axis]), slope = glm::dot(ray, box.axes[axis]);
    const double first = (-box.half[axis] - at) / slope, second = (box.half[axis] - at) / slope;
    low = std::max(low, std::min(first, second));
    high = std::min(high, std::max(first, second));
  }
  return low <= high;
}

class RandomView {
 public:
  explicit RandomView(uint32_t seed) : random_(seed) {}

  FrothCamera camera() {
    const View view = lookAt({}, point(1), 64, 48, std::exp(within(-4, 2)));
    FrothCamera camera = infoOf(view).camera;
    camera.scissor = {{static_cast<int32_t>(within(0, 40)), static_cast<int32_t>(within(0, 30))},
                      {static_cast<uint32_t>(within(1, 24)), static_cast<uint32_t>(within(1, 18))}};
    camera.jitter[0] = static_cast<float>(within(-0.5, 0.5));
    return camera;
  }
  PlacedBox box() {
    const double size = std::exp(within(-3, 1.5));
    const glm::dquat turn = glm::angleAxis(within(0, 6), glm::normalize(point(1)));
    return {point(5), glm::mat3_cast(turn), size * glm::dvec3(within(0.1, 1), within(0.1, 1), within(0.1, 1))};
  }

 private:
  double within(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  glm::dvec3 point(double reach) { return {within(-reach, reach), within(-reach, reach), within(-reach, reach)}; }
  std::mt19937 random_;
};

RayPyramid pyramidOf(const FrothCamera& camera, const RenderInstance& instance = {}) {
  return RayPyramid(camera, computeCameraRays(camera, instance));
}

bool isMetByAnyPixel(const PlacedBox& box, const FrothCamera& camera) {
  const CameraRays rays = computeCameraRays(camera, RenderInstance{});
  for (uint32_t row = 0; row < camera.scissor.extent.height; ++row) {
    for (uint32_t column = 0; column < camera.scissor.extent.width; ++column) {
      if (meets(box, rays.origin + double(column) * rays.stepX + double(row) * rays.stepY)) return true;
    }
  }
  return false;
}

TEST(RayPyramid, LeavesOutWhatNoRayMeetsAndNothingElse) {
  size_t met = 0, missed = 0, leftOut = 0;
  for (uint32_t seed = 1; seed <= 300; ++seed) {
    RandomView random(seed);
    const FrothCamera camera = random.camera();
    const RayPyramid rays = pyramidOf(camera);
    for (int i = 0; i < 100; ++i) {
      const PlacedBox box = random.box();
      const bool isMet = isMetByAnyPixel(box, camera), mayMeet = rays.mayMeet(box);
      EXPECT_TRUE(mayMeet || !isMet) << "seed " << seed << ", box " << i;
      (isMet ? met : missed) += 1;
      leftOut += mayMeet ? 0 : 1;
    }
  }
  std::printf("%zu boxes are met; of %zu others %zu are left out\n", met, missed, leftOut);
  EXPECT_GT(met, 1000u);
  EXPECT_GT(leftOut, missed * 9 / 10);
}

TEST(RayPyramid, OfOtherLensesIsAllAround) {
  View view = lookAt({}, {0, 0, 1}, 64, 48, 0.5);
  const PlacedBox behind{{0, 0, -10}, glm::dmat3(1), {1, 1, 1}};
  FrothCamera camera = infoOf(view).camera;
  camera.scissor.extent = {64, 48};
  EXPECT_FALSE(pyramidOf(camera).mayMeet(behind));
  for (const LensKind kind : {LensKind::kFisheye, LensKind::kOrthographic}) {
    view.lens.kind = kind;
    camera = infoOf(view).camera;
    camera.scissor.extent = {64, 48};
    EXPECT_TRUE(pyramidOf(camera).mayMeet(behind));
  }
}

// Three in a row along x; the instance stands turned by a quarter about z and moved, so in the world they go along y.
TEST(ChunkTable, HasNoWorkgroupsForChunksBesideTheView) {
  RenderInstance instance;
  instance.position = {100, 0, 0};
  instance.rotation = {0, 0, std::sqrt(0.5f), std::sqrt(0.5f)};
  GpuAsset asset;
  for (int i = 0; i < 3; ++i) {
    GpuChunk chunk;
    chunk.cellCount = chunk.liveCount = gpu::kGroupSize + 1;
    chunk.liveLow = {4.0 * i - 1, -1, 9};
    chunk.liveHigh = {4.0 * i + 1, 1, 11};
    asset.add(chunk);
  }
  std::vector<gpu::ChunkEntry> entries(3);
  const auto groupsOf = [&](const RayPyramid& rays) { return fillChunks(asset, {}, rays, entries.data()); };
  EXPECT_EQ(groupsOf({}), 6u);
  FrothCamera camera = infoOf(lookAt({100, 0, 0}, {100, 4, 10}, 64, 48, 0.1)).camera;
  camera.scissor.extent = {64, 48};
  EXPECT_EQ(groupsOf(pyramidOf(camera, instance)), 2u);
  EXPECT_EQ(entries[1].firstGroup, 0u);
  EXPECT_EQ(entries[2].firstGroup, 2u);
}

// Two clumps of cells, a chunk each: the view is in the box around both and sees neither.
TEST(ChunkTable, OfAViewBetweenChunksDrawsNothing) {
  Foam foam = makeRandomFoam(60, 2, 1, 3);
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) foam.sites[cell].x += cell % 2 == 0 ? -8.0f : 8.0f;
  Stage stage(splitAsset(bakeForTest(foam), 2, 0x1p-10), {48, 32});
  const Frame between = stage.draw(Method::kRaster, lookAt({0, 0, -3}, {0, 0, 3}, 48, 32, 0.3));
  EXPECT_EQ(between.status.visibleCells, 0u);
  EXPECT_EQ(between.status.pairs, 0u);
  EXPECT_EQ(between.status.bits, 0u);
  for (const float value : between.colour.values) ASSERT_EQ(value, 0.0f);
  for (const float value : between.distance.values) ASSERT_TRUE(std::isinf(value));
  for (const float x : {-8.0f, 8.0f}) {
    const Frame seen = stage.draw(Method::kRaster, lookAt({x, 0, -3}, {x, 0, 3}, 48, 32, 0.3));
    EXPECT_GT(*std::ranges::max_element(seen.alpha.values), 0.5f) << x;
    EXPECT_GT(seen.status.visibleCells, 10u) << x;
  }
}

// Names of the passes of a frame that the context's instances are seen in.
std::vector<std::string> passesOf(const View& view) {
  FrothContext* context = sharedContext();
  auto viewInfo = makeStruct<FrothViewInfo>();
  viewInfo.maxExtent = {view.width, view.height};
  viewInfo.measurePasses = 1;
  FrothView measured{};
  check(frothCreateView(context, &viewInfo, &measured), "frothCreateView");
  Result<HostImage> colour = sharedHost().createImage(VK_FORMAT_R16G16B16A16_SFLOAT, viewInfo.maxExtent);
  FrothRenderInfo info = infoOf(view);
  info.colour = sharedHost().describe(*colour);
  for (const bool isDrawn : {false, true, false}) {  // the view's room is made, the frame is drawn, its status comes
    const Status submitted = sharedHost().submit([&](VkCommandBuffer commands, uint64_t serial) -> Status {
      auto frame = makeStruct<FrothFrame>();
      frame.serial = serial;
      frame.completedSerial = serial - 1;
      check(frothUpdate(context, &frame, nullptr), "frothUpdate");
      check(frothRecordUpload(context, commands), "frothRecordUpload");
      if (isDrawn) check(frothRecordRaster(context, measured, commands, &info), "frothRecordRaster");
      return {};
    });
    EXPECT_TRUE(submitted) << submitted.error().message;
  }
  auto status = makeStruct<FrothViewStatus>();
  check(frothGetViewStatus(context, measured, &status), "frothGetViewStatus");
  std::vector<std::string> names;
  for (uint32_t pass = 0; pass < status.passCount; ++pass) names.emplace_back(status.passes[pass].name);
  check(frothDestroyView(context, measured), "frothDestroyView");
  sharedHost().destroyImage(*colour);
  return names;
}

TEST(PlacedBox, BesideTheViewTakesNoPasses) {
  const Stage stage(bakeForTest(makeRandomFoam(50, 1, 0, 3)), {32, 32});  // around (0, 0, 3)
  EXPECT_EQ(passesOf(lookAt({0, 0, -3}, {0, 0, 3}, 32, 32, 0.3)),
            (std::vector<std::string>{"cull", "sort", "bin", "raster"}));
  EXPECT_EQ(passesOf(lookAt({0, 0, -3}, {0, 0, -9}, 32, 32, 0.3)), std::vector<std::string>{"clear"});
  EXPECT_EQ(passesOf(lookAt({0, 0, -3}, {9, 0, -3}, 32, 32, 0.3)), std::vector<std::string>{"clear"});
}

}  // namespace
}  // namespace froth::test
