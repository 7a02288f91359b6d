// What is drawn of an asset with levels of detail: any cut is the power diagram of its cells, for rasters and walks.
#include <random>

#include <gtest/gtest.h>

#include "runtime/context/context.h"
#include "tests/levels/level_scene.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr uint32_t kWidth = 128, kHeight = 96;
constexpr VkExtent2D kExtent = {kWidth, kHeight};
constexpr int kMostFrames = 100;  // until a cut is drawn

std::vector<View> views() {
  return {lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, kWidth, kHeight, 0.6),
          lookAt({0.3, 0.2, 2.6}, {0, -0.1, 3.4}, kWidth, kHeight, 0.9)};
}

class LevelStage : public Stage {
 public:
  explicit LevelStage(bool keepsHits = false)
      : Stage(levelScene().levels, kExtent, sharedContext(), 0, 0, keepsHits, 0, false) {}

  void want(const std::vector<uint32_t>& cut) { context()->setCut(asset(), cut); }
  bool isDrawn(const std::vector<uint32_t>& cut) const {
    return std::ranges::equal(cut, context()->findAsset(asset())->drawnChunks());
  }
  void show(const std::vector<uint32_t>& cut) {
    want(cut);
    for (int frame = 0; frame < kMostFrames && !isDrawn(cut); ++frame) submit({});
    ASSERT_TRUE(isDrawn(cut));
  }
};

std::vector<std::vector<uint32_t>> cutsToShow() {
  const LevelScene& scene = levelScene();
  return {scene.floor(), scene.cut(0), scene.cut(15), scene.cut(5), scene.cut(8), scene.cut(7)};
}

TEST(Cuts, BeginWithLevelZeroWhereTheBudgetHasRoom) {
  LevelStage stage;
  const std::vector<uint32_t> finest = levelScene().cut(15);
  for (int frame = 0; frame < kMostFrames && !stage.isDrawn(finest); ++frame) stage.submit({});
  EXPECT_TRUE(stage.isDrawn(finest));
  const FrothAssetStatus status = stage.assetStatus();
  EXPECT_EQ(status.cellCount, levelScene().whole[0].chunks[0].cellCount);
  EXPECT_EQ(status.chunkCount, 13u);
}

TEST(Cuts, OfAnyLevelsAreTheRasterOfOneChunkBitForBit) {
  std::vector<Frame> found, expected;
  {
    LevelStage stage;
    for (const std::vector<uint32_t>& cut : cutsToShow()) {
      stage.show(cut);
      for (const View& view : views()) found.push_back(stage.draw(Method::kRaster, view));
    }
  }
  for (const std::vector<uint32_t>& cut : cutsToShow()) {
    Stage stage(levelScene().mixed(cut), kExtent);
    for (const View& view : views()) expected.push_back(stage.draw(Method::kRaster, view));
  }
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].colour.values, expected[i].colour.values) << i;
    EXPECT_EQ(found[i].distance.values, expected[i].distance.values) << i;
  }
  EXPECT_LT(psnr(found[0].colour, found[2].colour), 30) << "levels look alike";
}

TEST(Cuts, ByWalkAreThoseByRasterAndTheReference) {
  LevelStage stage;
  for (const std::vector<uint32_t>& cut : cutsToShow()) {
    stage.show(cut);
    const Result<Foam> foam = foamFromAsset(levelScene().mixed(cut));
    ASSERT_TRUE(foam) << foam.error().message;
    for (const View& view : views()) {
      const Frame raster = stage.draw(Method::kRaster, view), walk = stage.draw(Method::kWalk, view);
      EXPECT_EQ(walk.status.bits, 0u);
      EXPECT_GE(psnr(walk.colour, raster.colour), 60);
      EXPECT_LE(overTwoSteps(walk.colour, raster.colour), 1e-4);
      const RenderedImages reference = renderReference(*foam, view, 1e-3);
      EXPECT_GE(psnr(walk.colour, reference.colour), 60);
      EXPECT_LE(overTwoSteps(walk.colour, reference.colour), 1e-4);
    }
  }
}

TEST(Cuts, NameCellsByTheChunkInTheFile) {
  LevelStage stage(true);
  const LevelScene& scene = levelScene();
  const uint32_t bits = stage.assetStatus().cellBits;
  for (const std::vector<uint32_t>& cut : cutsToShow()) {
    stage.show(cut);
    const Result<Foam> foam = foamFromAsset(scene.mixed(cut));
    ASSERT_TRUE(foam);
    const RenderedImages reference = renderReference(*foam, views()[0], 1e-3);
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      const Frame frame = stage.draw(method, views()[0]);
      size_t differing = 0, met = 0;
      for (size_t i = 0; i < frame.id.size(); ++i) {
        const uint32_t code = frame.id[i][1];
        if (code == UINT32_MAX || reference.cells[i] == UINT32_MAX) continue;
        const uint32_t chunk = code >> bits, local = code & ((1u << bits) - 1);
        ASSERT_TRUE(std::ranges::count(cut, chunk) == 1 && local < scene.cells[chunk].size()) << chunk << ", " << local;
        differing += foam->radii[reference.cells[i]] != scene.levels.chunks[chunk].radii[local];
        ++met;
      }
      EXPECT_GT(met, frame.id.size() / 10);
      EXPECT_LE(differing, 2 + met / 1000);
    }
  }
}

// A frame that will not be submitted told walks where the borders are.
TEST(Cuts, AreToldToWalksAgainAfterADroppedFrame) {
  LevelStage stage;
  const View view = views()[1];
  stage.show(levelScene().cut(0));
  stage.draw(Method::kWalk, view);
  stage.show(levelScene().cut(6));
  Result<HostImage> image = sharedHost().createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kExtent);
  FrothRenderInfo info = infoOf(view);
  info.colour = sharedHost().describe(*image);
  const Status refused = sharedHost().submit([&](VkCommandBuffer commandBuffer, uint64_t serial) -> Status {
    const FrothFrame frame{sizeof(FrothFrame), serial, serial - 1, 0, 0, 0, 0};
    check(frothUpdate(stage.context(), &frame, nullptr), "frothUpdate");
    check(frothRecordWalk(stage.context(), stage.view(), commandBuffer, &info), "frothRecordWalk");
    check(frothDropFrame(stage.context(), serial), "frothDropFrame");
    return makeError(ErrorKind::kCancelled, "dropped");
  });
  EXPECT_FALSE(refused);
  sharedHost().destroyImage(*image);
  const Frame walk = stage.draw(Method::kWalk, view), raster = stage.draw(Method::kRaster, view);
  EXPECT_GE(psnr(walk.colour, raster.colour), 60);
}

}  // namespace
}  // namespace froth::test
