// Foams that are hardly foams bake too.
#include <gtest/gtest.h>

#include "baker/bake/bake.h"
#include "tests/bake/random_foam.h"

namespace froth {
namespace {

Foam foamOf(const BallSet& balls) {
  Foam foam = makeRandomFoam(balls.size(), 1, 2, 1);
  foam.sites = balls.sites;
  foam.radii = balls.radii;
  return foam;
}

void expectWholeBake(const Foam& foam, const BakeOptions& options) {
  const Result<BakeResult> result = bakeFoam(foam, options);
  ASSERT_TRUE(result) << result.error().message;
  const BakeStatistics& statistics = result->contents.statistics;
  EXPECT_EQ(statistics.inputCells, foam.cellCount);
  EXPECT_EQ(result->sourceCells.size(), foam.cellCount - statistics.hiddenDropped + statistics.steinerCells);
  EXPECT_GE(result->sourceCells.size(), 1u);
  EXPECT_TRUE(foamFromAsset(result->contents));
}

TEST(Degenerate, BallSetsOfEveryKindBake) {
  for (const BallSet& balls : makeBallSets(4)) {
    SCOPED_TRACE(balls.name);
    BakeOptions options;
    options.measure = false;
    options.chunkCells = 20;
    expectWholeBake(foamOf(balls), options);
    options.knobs.positionBits = 12;
    options.knobs.radiusBits = 6;
    options.knobs.frameBits = 6;
    expectWholeBake(foamOf(balls), options);
  }
}

TEST(Degenerate, ManyCopiesOfOneCellAreOneCell) {
  Foam foam = makeRandomFoam(20, 1, 2, 1);
  for (uint32_t i = 0; i < 20; ++i) foam.sites[i] = foam.sites[0];
  BakeOptions options;
  options.knobs.positionBits = 16;
  const Result<BakeResult> result = bakeFoam(foam, options);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->contents.statistics.duplicatesMerged, 19u);
}

TEST(Degenerate, AFoamWithoutLiveCellsBakes) {
  Foam foam = makeRandomFoam(30, 1, 2, 1);
  std::fill(foam.densities.begin(), foam.densities.end(), 0.0f);
  BakeOptions options;
  const Result<BakeResult> with = bakeFoam(foam, options);
  ASSERT_TRUE(with) << with.error().message;
  EXPECT_EQ(with->contents.chunks.at(0).liveCount, 0u);
}

}  // namespace
}  // namespace froth
