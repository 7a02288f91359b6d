// Trained foams; skipped where the data is absent.
#include <cstdlib>
#include <filesystem>
#include <optional>

#include <gtest/gtest.h>

#include "baker/bake/bake.h"
#include "foam/checkpoint/checkpoint.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

std::optional<std::filesystem::path> findCheckpoint(const char* name) {
  const std::filesystem::path path = test::dataFolder() / "foams" / name / "model.pt";
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

double meanAlphaDegree(const AssetContents& contents) {
  uint64_t sum = 0, cells = 0;
  for (const ChunkContents& chunk : contents.chunks) {
    for (const uint32_t count : chunk.alphaCounts) sum += count;
    cells += chunk.liveCount;
  }
  return static_cast<double>(sum) / static_cast<double>(cells);
}

Result<BakeResult> bakeWithoutSteiner(const Foam& foam) {
  BakeOptions options;
  options.steiner = false;
  return bakeFoam(foam, options);
}

// The counts were found by another implementation: 6.95 planes per cell, 0.1 % of the cells without a bounded
// cell.
TEST(RealFoam, MikuPlushHasTheKnownCounts) {
  const auto path = findCheckpoint("miku_plush");
  if (!path) FROTH_SKIP() << "no foams/miku_plush; set FROTH_DATA";
  const Result<Foam> foam = importCheckpoint(*path);
  ASSERT_TRUE(foam) << foam.error().message;
  const Result<BakeResult> baked = bakeWithoutSteiner(*foam);
  ASSERT_TRUE(baked) << baked.error().message;
  const BakeStatistics& statistics = baked->contents.statistics;
  EXPECT_EQ(statistics.inputCells, 39999u);
  EXPECT_LE(statistics.hiddenDropped + statistics.emptyCells, 40u);
  EXPECT_EQ(statistics.duplicatesMerged, 0u);
  EXPECT_NEAR(meanAlphaDegree(baked->contents), 6.95, 0.01);
  EXPECT_EQ(baked->contents.chunks.size(), 3u);
  EXPECT_NEAR(2.0 * statistics.walkPairs / 39999, 15.15, 0.05);
}

TEST(RealFoam, TankardRoughBakesThoughItIsBadlyTrained) {
  const auto path = findCheckpoint("tankard_rough");
  if (!path) FROTH_SKIP() << "no foams/tankard_rough; set FROTH_DATA";
  const Result<Foam> foam = importCheckpoint(*path);
  ASSERT_TRUE(foam) << foam.error().message;
  const Result<BakeResult> baked = bakeWithoutSteiner(*foam);
  ASSERT_TRUE(baked) << baked.error().message;
  const BakeStatistics& statistics = baked->contents.statistics;
  EXPECT_EQ(statistics.hiddenDropped + baked->sourceCells.size(), 59999u);
  EXPECT_GT(statistics.hiddenDropped, 0u);
  EXPECT_GT(statistics.emptyCells, 0u);
  EXPECT_NEAR(meanAlphaDegree(baked->contents), 12.87, 0.05);
}

}  // namespace
}  // namespace froth
