// What is drawn of an asset with levels of detail: any cut is the power diagram of its cells, for rasters and walks.
#include <gtest/gtest.h>

#include "runtime/context/context.h"
#include "tests/levels/level_cuts.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr uint32_t kWidth = 128, kHeight = 96;
constexpr VkExtent2D kExtent = {kWidth, kHeight};
constexpr int kMostFrames = 100;  // until a cut is drawn

// From outside, and from between the cells.
std::vector<View> views() {
  return {lookAt({0.2, 0.3, -5}, {0, 0, 0}, kWidth, kHeight, 0.4),
          lookAt({0.3, 0.2, -0.4}, {0, -0.1, 0.4}, kWidth, kHeight, 0.9)};
}

class LevelStage : public Stage {
 public:
  explicit LevelStage(bool keepsHits = false)
      : Stage(levelSample(), kExtent, sharedContext(), 0, 0, keepsHits, 0, false) {}

  bool isDrawn(const std::vector<uint32_t>& cut) const {
    return std::ranges::equal(cut, context()->findAsset(asset())->drawnChunks());
  }
  void waitFor(const std::vector<uint32_t>& cut) {
    for (int frame = 0; frame < kMostFrames && !isDrawn(cut); ++frame) submit({});
    ASSERT_TRUE(isDrawn(cut));
  }
  void show(const std::vector<uint32_t>& cut) {
    context()->setCut(asset(), cut);
    waitFor(cut);
  }
};

std::vector<std::vector<uint32_t>> cutsToShow() {
  std::vector<std::vector<uint32_t>> cuts = {floorCut(), finestCut()};
  std::mt19937 random(7);
  for (int i = 0; i < 6; ++i) cuts.push_back(randomCut(random));
  return cuts;
}

TEST(Cuts, AreWhatTheStatusCounts) {
  LevelStage stage;
  stage.show(finestCut());
  uint32_t cells = 0;
  for (const uint32_t chunk : finestCut()) cells += levelSample().chunks[chunk].cellCount;
  EXPECT_EQ(stage.assetStatus().cellCount, cells);
  EXPECT_EQ(stage.assetStatus().chunkCount, levelSample().chunks.size());
}

TEST(Cuts, ByWalkAreThoseByRasterAndTheReference) {
  LevelStage stage;
  std::vector<Image> images;
  for (const std::vector<uint32_t>& cut : cutsToShow()) {
    stage.show(cut);
    const Result<Foam> foam = foamFromAsset(contentsOf(cut));
    ASSERT_TRUE(foam) << foam.error().message;
    for (const View& view : views()) {
      const Frame raster = stage.draw(Method::kRaster, view), walk = stage.draw(Method::kWalk, view);
      EXPECT_EQ(walk.status.bits, 0u) << "a walk did not end";
      EXPECT_GE(psnr(walk.colour, raster.colour), 60);
      EXPECT_LE(overTwoSteps(walk.colour, raster.colour), 1e-4);
      const RenderedImages reference = renderReference(*foam, view, 1e-3);
      for (const Frame* frame : {&raster, &walk}) {
        EXPECT_GE(psnr(frame->colour, reference.colour), 60);
        EXPECT_LE(overTwoSteps(frame->colour, reference.colour), 1e-4);
      }
      images.push_back(raster.colour);
    }
  }
  EXPECT_LT(psnr(images[0], images[2]), 30) << "floor and level 0 look alike";
}

TEST(Cuts, NameCellsByTheChunkInTheFile) {
  LevelStage stage(true);
  const uint32_t bits = stage.assetStatus().cellBits;
  for (const std::vector<uint32_t>& cut : cutsToShow()) {
    stage.show(cut);
    const Result<Foam> foam = foamFromAsset(contentsOf(cut));
    ASSERT_TRUE(foam);
    const RenderedImages reference = renderReference(*foam, views()[0], 1e-3);
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      const Frame frame = stage.draw(method, views()[0]);
      size_t differing = 0, met = 0;
      for (size_t i = 0; i < frame.id.size(); ++i) {
        const uint32_t code = frame.id[i][1];
        if (code == UINT32_MAX || reference.cells[i] == UINT32_MAX) continue;
        const uint32_t chunk = code >> bits, local = code & ((1u << bits) - 1);
        ASSERT_TRUE(std::ranges::binary_search(cut, chunk)) << chunk;
        ASSERT_LT(local, levelSample().chunks[chunk].liveCount) << chunk;
        differing += foam->radii[reference.cells[i]] != levelSample().chunks[chunk].radii[local];
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
  stage.show(floorCut());
  stage.draw(Method::kWalk, view);
  stage.show(finestCut());
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
