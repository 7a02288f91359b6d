// Chunks: complete in themselves, and together the whole scene.
#include <algorithm>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baker/bake/bake.h"
#include "format/checks.h"
#include "format/write/asset_writer.h"
#include "tests/bake/random_foam.h"

namespace froth {
namespace {

BakeResult bakeInChunks(const Foam& foam, uint32_t chunkCells, BakeOptions options = {}) {
  options.chunkCells = chunkCells;
  options.measure = false;
  Result<BakeResult> result = bakeFoam(foam, options);
  EXPECT_TRUE(result) << result.error().message;
  return std::move(*result);
}

BakeOptions latticeOptions() {
  BakeOptions options;
  options.knobs.positionBits = 16;
  options.knobs.radiusBits = 9;
  options.steiner = false;
  return options;
}

// Where a site of a chunk lives: its own cell, or a ghost's.
CellRef refOf(const AssetContents& contents, uint32_t chunk, uint32_t site) {
  const uint32_t cells = contents.chunks[chunk].cellCount;
  if (site >= cells) return contents.chunks[chunk].ghostRefs[site - cells];
  return static_cast<CellRef>(uint64_t{chunk} << contents.localBits) | site;
}

// All pairs {from, to}, with whether they are in the alpha part of a row.
std::map<std::pair<CellRef, CellRef>, bool> collectPairs(const AssetContents& contents) {
  std::map<std::pair<CellRef, CellRef>, bool> pairs;
  for (uint32_t index = 0; index < contents.chunks.size(); ++index) {
    const ChunkContents& chunk = contents.chunks[index];
    for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
      const uint32_t first = chunk.neighbourOffsets[cell];
      const uint32_t alphaEnd = first + (cell < chunk.liveCount ? chunk.alphaCounts[cell] : 0);
      for (uint32_t entry = first; entry < chunk.neighbourOffsets[cell + 1]; ++entry) {
        pairs[{refOf(contents, index, cell), refOf(contents, index, chunk.neighbours[entry])}] = entry < alphaEnd;
      }
    }
  }
  return pairs;
}

glm::dvec3 worldSite(const ChunkContents& chunk, uint32_t site) {
  return glm::dvec3(chunk.origin[0], chunk.origin[1], chunk.origin[2]) + glm::dvec3(chunk.sites[site]);
}

TEST(Chunks, HoldNearlyTheSameNumberOfLiveCells) {
  const BakeResult result = bakeInChunks(makeRandomFoam(1000, 1, 1, 3), 130);
  ASSERT_EQ(result.contents.chunks.size(), 8u);
  EXPECT_EQ(result.contents.localBits, 7u);
  const uint32_t first = result.contents.chunks[0].liveCount;
  EXPECT_LE(first, 130u);
  for (const ChunkContents& chunk : result.contents.chunks) EXPECT_NEAR(chunk.liveCount, first, 1);
}

// References of one cell need no bit to tell cells of a chunk apart, but a file has one at least.
TEST(Chunks, MayHoldOneLiveCellEach) {
  BakeOptions options;
  options.steiner = false;
  const BakeResult result = bakeInChunks(makeRandomFoam(9, 1, 1, 3), 1, options);
  ASSERT_EQ(result.contents.chunks.size(), 9u);
  EXPECT_EQ(result.contents.localBits, 1u);
  const Result<std::vector<uint8_t>> bytes = encodeAsset(result.contents);
  EXPECT_TRUE(bytes) << bytes.error().message;
}

TEST(Chunks, TogetherHoldEveryCellOnce) {
  const BakeResult result = bakeInChunks(makeMixedFoam(), 50, latticeOptions());
  const std::set<uint32_t> sources(result.sourceCells.begin(), result.sourceCells.end());
  EXPECT_EQ(sources.size(), result.sourceCells.size());
  EXPECT_EQ(sources.size() + result.contents.statistics.hiddenDropped, 400u);
}

// Ghosts are the very numbers of the cells they stand for, on one grid for the scene.
TEST(Chunks, GhostsAreExactCopiesOfCellsElsewhere) {
  for (const BakeOptions& options : {BakeOptions{}, latticeOptions()}) {
    const BakeResult result = bakeInChunks(makeMixedFoam(), 50, options);
    const AssetContents& contents = result.contents;
    ASSERT_GT(contents.chunks.size(), 4u);
    for (uint32_t index = 0; index < contents.chunks.size(); ++index) {
      const ChunkContents& chunk = contents.chunks[index];
      EXPECT_GT(chunk.ghostCount, 0u);
      EXPECT_TRUE(std::is_sorted(chunk.ghostRefs.begin(), chunk.ghostRefs.end()));
      ASSERT_EQ(chunk.sites.size(), chunk.cellCount + chunk.ghostCount);
      for (uint32_t ghost = 0; ghost < chunk.ghostCount; ++ghost) {
        const uint32_t home = chunkOf(chunk.ghostRefs[ghost], contents.localBits);
        const uint32_t local = localOf(chunk.ghostRefs[ghost], contents.localBits);
        ASSERT_NE(home, index);
        ASSERT_LT(local, contents.chunks.at(home).cellCount);
        EXPECT_EQ(worldSite(chunk, chunk.cellCount + ghost), worldSite(contents.chunks[home], local));
        EXPECT_EQ(chunk.radii[chunk.cellCount + ghost], contents.chunks[home].radii[local]);
      }
    }
  }
}

// The graph of many chunks is the graph of one.
TEST(Chunks, RowsNameTheSameNeighboursHoweverTheSceneIsSplit) {
  const Foam foam = makeMixedFoam();
  const auto pairsOfSources = [&](uint32_t chunkCells) {
    const BakeResult result = bakeInChunks(foam, chunkCells, latticeOptions());
    const AssetContents& contents = result.contents;
    std::vector<uint32_t> firstPlace{0};
    for (const ChunkContents& chunk : contents.chunks) firstPlace.push_back(firstPlace.back() + chunk.cellCount);
    const auto sourceOf = [&](CellRef ref) {
      return result.sourceCells[firstPlace[chunkOf(ref, contents.localBits)] + localOf(ref, contents.localBits)];
    };
    std::map<std::pair<uint32_t, uint32_t>, bool> pairs;
    for (const auto& [pair, isAlpha] : collectPairs(contents)) {
      pairs[{sourceOf(pair.first), sourceOf(pair.second)}] = isAlpha;
    }
    return pairs;
  };
  const auto whole = pairsOfSources(16384);
  EXPECT_GT(whole.size(), 4000u);
  EXPECT_EQ(pairsOfSources(37), whole);
}

// Without a walk graph only live cells have rows.
TEST(Chunks, EveryPairIsThereFromBothSides) {
  for (const bool walkGraph : {true, false}) {
    BakeOptions options = latticeOptions();
    options.walkGraph = walkGraph;
    const AssetContents contents = bakeInChunks(makeMixedFoam(), 50, options).contents;
    const auto pairs = collectPairs(contents);
    const auto isLive = [&](CellRef ref) {
      const ChunkContents& chunk = contents.chunks[chunkOf(ref, contents.localBits)];
      return localOf(ref, contents.localBits) < chunk.liveCount;
    };
    for (const auto& [pair, isAlpha] : pairs) {
      if (!walkGraph && !isLive(pair.second)) continue;
      ASSERT_TRUE(pairs.count({pair.second, pair.first}));
    }
  }
}

// Steiner cells fill empty space and touch nothing: live cells, their order and their alpha rows stay as they were.
TEST(Chunks, LiveCellsAreTheSameWithAndWithoutSteinerCells) {
  Foam foam = makeRandomFoam(600, 1, 2, 9);
  for (float& radius : foam.radii) radius *= 0.3f;  // space between the balls
  for (BakeOptions options : {BakeOptions{}, latticeOptions()}) {
    options.steiner = false;
    const BakeResult without = bakeInChunks(foam, 100, options);
    options.steiner = true;
    const BakeResult with = bakeInChunks(foam, 100, options);
    EXPECT_GT(with.contents.statistics.steinerCells, 0u);
    ASSERT_EQ(without.contents.chunks.size(), with.contents.chunks.size());
    for (size_t index = 0; index < with.contents.chunks.size(); ++index) {
      const ChunkContents &a = without.contents.chunks[index], &b = with.contents.chunks[index];
      ASSERT_EQ(a.liveCount, b.liveCount);
      EXPECT_EQ(a.origin, b.origin);
      EXPECT_EQ(a.alphaCounts, b.alphaCounts);
      EXPECT_EQ(a.densities, b.densities);
      EXPECT_EQ(a.lobeColours, b.lobeColours);
      for (uint32_t cell = 0; cell < a.liveCount; ++cell) {
        EXPECT_EQ(a.sites[cell], b.sites[cell]);
        EXPECT_EQ(a.radii[cell], b.radii[cell]);
        for (uint32_t k = 0; k < a.alphaCounts[cell]; ++k) {
          EXPECT_EQ(worldSite(a, a.neighbours[a.neighbourOffsets[cell] + k]),
                    worldSite(b, b.neighbours[b.neighbourOffsets[cell] + k]));
        }
      }
    }
  }
}

// So that few pairs of neighbours lie across chunks.
TEST(Chunks, OtherCellsAreWhereMostOfTheirLiveNeighboursAre) {
  Foam foam = makeRandomFoam(600, 1, 2, 9);
  for (float& radius : foam.radii) radius *= 0.3f;  // space between the balls
  const AssetContents contents = bakeInChunks(foam, 100).contents;
  ASSERT_GT(contents.chunks.size(), 4u);
  size_t seen = 0;
  for (uint32_t index = 0; index < contents.chunks.size(); ++index) {
    const ChunkContents& chunk = contents.chunks[index];
    for (uint32_t cell = chunk.liveCount; cell < chunk.cellCount; ++cell) {
      std::vector<size_t> live(contents.chunks.size(), 0);
      for (uint32_t entry = chunk.neighbourOffsets[cell]; entry < chunk.neighbourOffsets[cell + 1]; ++entry) {
        const CellRef ref = refOf(contents, index, chunk.neighbours[entry]);
        const uint32_t home = chunkOf(ref, contents.localBits);
        live[home] += localOf(ref, contents.localBits) < contents.chunks[home].liveCount ? 1 : 0;
      }
      const size_t most = *std::max_element(live.begin(), live.end());
      if (most == 0) continue;  // only Steiner cells around it
      EXPECT_EQ(live[index], most);
      seen += most > live[0];
    }
  }
  EXPECT_GT(seen, 20u);
}

TEST(Chunks, WithoutAWalkGraphKeepTheAlphaComplexOfLiveCells) {
  BakeOptions options = latticeOptions();
  const BakeResult with = bakeInChunks(makeMixedFoam(), 50, options);
  options.walkGraph = false;
  const BakeResult without = bakeInChunks(makeMixedFoam(), 50, options);
  EXPECT_FALSE(without.contents.hasWalkGraph);
  EXPECT_LT(without.sourceCells.size(), with.sourceCells.size());  // empty cells cut nothing that is drawn
  ASSERT_EQ(without.contents.chunks.size(), with.contents.chunks.size());
  for (size_t index = 0; index < with.contents.chunks.size(); ++index) {
    const ChunkContents &a = with.contents.chunks[index], &b = without.contents.chunks[index];
    ASSERT_EQ(a.liveCount, b.liveCount);
    EXPECT_EQ(a.alphaCounts, b.alphaCounts);
    for (uint32_t cell = 0; cell < a.liveCount; ++cell) {
      EXPECT_EQ(a.sites[cell], b.sites[cell]);
      EXPECT_EQ(b.neighbourOffsets[cell + 1] - b.neighbourOffsets[cell], b.alphaCounts[cell]);
      for (uint32_t k = 0; k < b.alphaCounts[cell]; ++k) {
        EXPECT_EQ(worldSite(a, a.neighbours[a.neighbourOffsets[cell] + k]),
                  worldSite(b, b.neighbours[b.neighbourOffsets[cell] + k]));
      }
    }
  }
  EXPECT_TRUE(std::any_of(without.leftOut.begin(), without.leftOut.end(), [](const LeftOut& leftOut) {
    return leftOut.what == "walk graph" && leftOut.savedBytes > 0;
  }));
}

}  // namespace
}  // namespace froth
