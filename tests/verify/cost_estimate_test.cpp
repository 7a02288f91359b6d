// The figures by which `froth verify` warns of assets that are slow to draw.
#include "baker/verify/cost_estimate.h"

#include <gtest/gtest.h>

namespace froth {
namespace {

// `count` equal balls in one point, without a graph.
AssetContents pileOf(uint32_t count) {
  AssetContents contents;
  ChunkContents& chunk = contents.chunks.emplace_back();
  chunk.cellCount = chunk.liveCount = count;
  chunk.sites.assign(count, glm::vec3(1, 2, 3));
  chunk.radii.assign(count, 0.5f);
  chunk.neighbourOffsets.assign(count + 1, 0);
  chunk.alphaCounts.assign(count, 0);
  return contents;
}

TEST(CostEstimate, CountsTheBallsOverARay) {
  for (const bool hasStartView : {false, true}) {
    AssetContents contents = pileOf(3000);
    contents.hasStartView = hasStartView;  // from the world's origin
    const CostEstimate cost = estimateCost(contents);
    EXPECT_EQ(cost.mostBalls, 3000u);
    EXPECT_NEAR(cost.meanBalls, 3000, 1e-6);
    EXPECT_EQ(cost.eyes, hasStartView ? 1u : 6u);
  }
}

TEST(CostEstimate, CountsSolidBallsWhereThereAreSome) {
  AssetContents contents = pileOf(100);
  // at the rim
  for (uint32_t i = 0; i < 100; ++i) contents.chunks[0].solidBalls.push_back(i < 40 ? kWholeBall : 0x01404020);
  contents.hasStartView = true;
  EXPECT_LT(estimateCost(contents).meanBalls, 100);
}

TEST(CostEstimate, FindsTheLongestRow) {
  AssetContents contents = pileOf(5);
  ChunkContents& chunk = contents.chunks[0];
  chunk.neighbourOffsets = {0, 4, 5, 6, 7, 8};
  chunk.neighbours = {1, 2, 3, 4, 0, 0, 0, 0};
  const CostEstimate cost = estimateCost(contents);
  EXPECT_EQ(cost.longestRow, 4u);
  EXPECT_EQ(cost.squaredDegrees, 20u);
}

TEST(CostEstimate, OfAnAssetWithoutLiveCellsIsZero) {
  AssetContents contents = pileOf(3);
  contents.chunks[0].liveCount = 0;
  contents.chunks[0].alphaCounts.clear();
  EXPECT_EQ(estimateCost(contents).rays, 0u);
}

}  // namespace
}  // namespace froth
