// What checkScene finds in assets whose structure is sound, and whose content lies.
#include "baker/verify/scene_check.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baker/bake/bake.h"
#include "tests/bake/random_foam.h"
#include "tests/format/level_sample.h"

namespace froth {
namespace {

using testing::HasSubstr;

AssetContents bake(const char* preset, uint32_t chunkCells = 1000, bool walkGraph = true) {
  BakeOptions options;
  options.knobs = *presetKnobs(preset);
  options.chunkCells = chunkCells;
  options.walkGraph = walkGraph;
  options.measure = false;
  Result<BakeResult> baked = bakeFoam(makeMixedFoam(), options);
  EXPECT_TRUE(baked) << baked.error().message;
  return std::move(baked->contents);
}

std::string errorOf(const AssetContents& contents) {
  const Result<ValidityReport> found = checkScene(contents);
  return found ? "no error" : found.error().message;
}

TEST(SceneCheck, FindsNothingWrongWithWhatWasBaked) {
  for (const char* preset : {"exact", "default"}) {
    EXPECT_EQ(errorOf(bake(preset)), "no error") << preset;
    EXPECT_EQ(errorOf(bake(preset, 50)), "no error") << preset;
    EXPECT_EQ(errorOf(bake(preset, 50, false)), "no error") << preset;
  }
}

TEST(SceneCheck, RefusesAGraphWithoutPairs) {
  AssetContents contents = bake("exact");
  ChunkContents& chunk = contents.chunks[0];
  chunk.neighbours.clear();
  std::fill(chunk.neighbourOffsets.begin(), chunk.neighbourOffsets.end(), 0u);
  std::fill(chunk.alphaCounts.begin(), chunk.alphaCounts.end(), 0u);
  EXPECT_THAT(errorOf(contents), HasSubstr("graphs: "));
}

TEST(SceneCheck, RefusesAnAlphaComplexWithoutPairs) {
  for (const bool walkGraph : {true, false}) {
    AssetContents contents = bake("exact", 1000, walkGraph);
    ChunkContents& chunk = contents.chunks[0];
    std::fill(chunk.alphaCounts.begin(), chunk.alphaCounts.end(), 0u);
    EXPECT_THAT(errorOf(contents), HasSubstr("by the alpha-complex")) << walkGraph;
  }
}

// The nearest planes come first, so a row without its first neighbour lets its cell grow.
TEST(SceneCheck, RefusesWalkRowsThatLackTheirNearestNeighbours) {
  AssetContents contents = bake("exact");
  ChunkContents& chunk = contents.chunks[0];
  for (uint32_t cell = 0; cell < chunk.cellCount; cell += 2) {
    chunk.neighbours[chunk.neighbourOffsets[cell]] = chunk.neighbours[chunk.neighbourOffsets[cell + 1] - 1];
  }
  EXPECT_THAT(errorOf(contents), HasSubstr("graphs: "));
}

TEST(SceneCheck, RefusesASolidBallThatIsTooSmallOrElsewhere) {
  const AssetContents valid = bake("default");
  const std::vector<uint32_t>& balls = valid.chunks[0].solidBalls;
  const auto tight = std::find_if(balls.begin(), balls.end(), [](uint32_t ball) { return ball != kWholeBall; });
  ASSERT_NE(tight, balls.end());
  const auto cell = static_cast<size_t>(tight - balls.begin());
  const uint32_t smaller = *tight - (1u << 24), none = *tight & 0xffffff, aside = (*tight & 0xff000000) | 0x202000;
  for (const uint32_t ball : {smaller, none, aside}) {
    AssetContents contents = valid;
    contents.chunks[0].solidBalls[cell] = ball;
    EXPECT_THAT(errorOf(contents), HasSubstr("chunk 0: the solid ball of cell " + std::to_string(cell)))
        << std::hex << ball;
  }
}

AssetContents bakeLevels() {
  BakeOptions options;
  options.knobs = *presetKnobs("default");
  options.chunkCells = 150;
  options.measure = false;
  options.levels = true;
  Result<BakeResult> baked = bakeFoam(makeRandomFoam(2000, 1, 1, 9), options);
  EXPECT_TRUE(baked) << baked.error().message;
  EXPECT_GE(baked->levels.size(), 2u);
  return std::move(baked->contents);
}

TEST(SceneCheck, FindsNothingWrongWithLevels) { EXPECT_EQ(errorOf(bakeLevels()), "no error"); }

TEST(SceneCheck, RefusesAFloorThatIsNoPowerDiagram) {
  AssetContents contents = bakeLevels();
  ASSERT_GT(contents.levels[0].level, 0u);
  ChunkContents& chunk = contents.chunks[0];
  for (uint32_t cell = 0; cell < chunk.cellCount; cell += 2) {
    chunk.neighbours[chunk.neighbourOffsets[cell]] = chunk.neighbours[chunk.neighbourOffsets[cell + 1] - 1];
  }
  EXPECT_THAT(errorOf(contents), HasSubstr("graphs: "));
}

TEST(SceneCheck, RefusesBordersThatNameOtherCells) {
  const AssetContents valid = bakeLevels();
  ASSERT_GE(valid.chunks.back().borderNumbers.size(), 2u);
  AssetContents swapped = valid;
  std::swap(swapped.chunks.back().borderNumbers[0], swapped.chunks.back().borderNumbers[1]);
  EXPECT_THAT(errorOf(swapped), HasSubstr("is another cell where it is drawn"));
  AssetContents missing = valid;
  missing.chunks.back().borderNumbers.pop_back();
  missing.chunks.back().borderCells.pop_back();
  EXPECT_THAT(errorOf(missing), HasSubstr("is not drawn"));
}

TEST(SceneCheck, RefusesToSampleSitesThatAreNoFloats) {
  AssetContents contents = bake("exact", 50);
  contents.chunks[1].origin[0] += 1e9;
  const Result<ValidityReport> found = checkScene(contents);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().kind, ErrorKind::kUnsupported);
}

// Radii of level 1 that do not fit to its graph: neither level 0 nor the floor has them.
TEST(SceneCheck, LooksBetweenTheFinestLevelAndTheFloor) {
  AssetContents contents = makeLevelSample();
  EXPECT_EQ(errorOf(contents), "no error");
  for (size_t i = 0; i < contents.chunks.size(); ++i) {
    ChunkContents& chunk = contents.chunks[i];
    if (contents.levels[i].level != 1) continue;
    for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
      const bool isBorder = std::ranges::binary_search(chunk.borderCells, cell);
      if (!isBorder) chunk.radii[cell] *= 1 + 0.2f * static_cast<float>(cell) / 100;
    }
  }
  EXPECT_THAT(errorOf(contents), HasSubstr("graphs: "));
}

}  // namespace
}  // namespace froth
