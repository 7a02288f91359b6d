#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "baker/lod/chunk_groups.h"

namespace froth {
namespace {

// A row of chunks of ten cells each; each has ten pairs of neighbours with the next one.
std::vector<LevelChunk> makeRowOfChunks(uint32_t count) {
  std::vector<LevelChunk> chunks(count);
  for (uint32_t index = 0; index < count; ++index) {
    LevelChunk& chunk = chunks[index];
    chunk.planned.liveCount = 10;
    chunk.rows = {{{0}, {}}, {{0}, {}}};
    for (uint32_t k = 0; k < 10; ++k) {
      chunk.planned.cells.push_back(10 * index + k);
      if (index > 0) chunk.rows.walk.neighbours.push_back(10 * (index - 1) + k);
      if (index + 1 < count) chunk.rows.walk.neighbours.push_back(10 * (index + 1) + k);
      chunk.rows.walk.offsets.push_back(static_cast<uint32_t>(chunk.rows.walk.neighbours.size()));
    }
  }
  return chunks;
}

std::vector<std::vector<uint32_t>> groupAll(const std::vector<LevelChunk>& chunks) {
  std::vector<uint32_t> all(chunks.size());
  std::iota(all.begin(), all.end(), 0u);
  return groupChunks(chunks, all, static_cast<uint32_t>(10 * chunks.size()), 40);
}

using Groups = std::vector<std::vector<uint32_t>>;

TEST(ChunkGroups, AreNeighboursAndCoverAllChunksOnce) {
  EXPECT_EQ(groupAll(makeRowOfChunks(8)), (Groups{{0, 1, 2, 3}, {4, 5, 6, 7}}));
}

TEST(ChunkGroups, AChunkLeftOverJoinsItsNeighbours) {
  EXPECT_EQ(groupAll(makeRowOfChunks(9)), (Groups{{0, 1, 2, 3}, {4, 5, 6, 7, 8}}));
}

TEST(ChunkGroups, HaveMoreChunksWhereThoseAreSmall) {
  std::vector<LevelChunk> chunks = makeRowOfChunks(10);
  for (LevelChunk& chunk : chunks) chunk.planned.liveCount = 7;
  EXPECT_EQ(groupAll(chunks), (Groups{{0, 1, 2, 3, 4}, {5, 6, 7, 8, 9}}));
}

// The first neighbour is full after two of its chunks, so the third, which borders on no other, stays.
TEST(ChunkGroups, ADissolvedGroupIsSharedByNeighboursWithRoom) {
  const Groups before{{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}};
  const std::vector<uint32_t> middle{1};
  EXPECT_EQ(dissolveGroups(makeRowOfChunks(12), before, middle, 120, 30),
            (Groups{{0, 1, 2, 3, 4, 5}, {6}, {7, 8, 9, 10, 11}}));
}

TEST(ChunkGroups, ADissolvedGroupStaysWhereNoOtherHasRoom) {
  const Groups before{{0, 1, 2, 3}, {4, 5, 6, 7}};
  const std::vector<uint32_t> second{1};
  EXPECT_EQ(dissolveGroups(makeRowOfChunks(8), before, second, 80, 20), before);
}

// Before a row of chunks stands a sheet of others, cell before cell, that have more pairs in common with each other.
TEST(ChunkGroups, ASheetBeforeAnotherIsSharedAmongTheGroupsBehindIt) {
  std::vector<LevelChunk> chunks = makeRowOfChunks(8);
  const auto link = [&](uint32_t a, uint32_t b) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      CellGraph& walk = chunks[from / 10].rows.walk;
      const uint32_t local = from % 10;
      walk.neighbours.insert(walk.neighbours.begin() + walk.offsets[local + 1], to);
      for (uint32_t k = local + 1; k <= 10; ++k) ++walk.offsets[k];
    }
  };
  for (uint32_t index = 0; index < 4; ++index) {
    LevelChunk& chunk = chunks.emplace_back();
    chunk.planned.liveCount = 10;
    chunk.rows = {{std::vector<uint32_t>(11), {}}, {{0}, {}}};
    for (uint32_t k = 0; k < 10; ++k) chunk.planned.cells.push_back(10 * (8 + index) + k);
    for (uint32_t k = 0; k < 10; ++k) link(10 * (8 + index) + k, 10 * (2 * index) + k);
    for (uint32_t k = 0; k < 30 && index > 0; ++k) link(10 * (8 + index) + k % 10, 10 * (7 + index) + k % 10);
  }
  for (const std::vector<uint32_t>& group : groupAll(chunks)) {
    const bool isSheet = std::all_of(group.begin(), group.end(), [](uint32_t chunk) { return chunk >= 8; });
    EXPECT_FALSE(isSheet) << testing::PrintToString(group);
  }
}

// Two columns of four chunks; each column was made by a group of its own, and has twice as many pairs of neighbours in
// it as it has with the other one.
//   0 - 4
//   |   |
//   1 - 5
//   ...
TEST(ChunkGroups, MixChunksOfDifferentMakers) {
  std::vector<LevelChunk> chunks(8);
  for (uint32_t index = 0; index < 8; ++index) {
    LevelChunk& chunk = chunks[index];
    chunk.planned.liveCount = 10;
    chunk.place.madeBy = index / 4;
    const uint32_t row = index % 4;
    std::vector<uint32_t> others{index ^ 4};
    if (row > 0) others.push_back(index - 1);
    if (row < 3) others.push_back(index + 1);
    chunk.rows = {{{0}, {}}, {{0}, {}}};
    for (uint32_t k = 0; k < 10; ++k) {
      chunk.planned.cells.push_back(10 * index + k);
      for (const uint32_t other : others) {
        const uint32_t pairs = other == (index ^ 4) ? 1 : 2;
        chunk.rows.walk.neighbours.insert(chunk.rows.walk.neighbours.end(), pairs, 10 * other + k);
      }
      chunk.rows.walk.offsets.push_back(static_cast<uint32_t>(chunk.rows.walk.neighbours.size()));
    }
  }
  for (const std::vector<uint32_t>& group : groupAll(chunks)) {
    std::set<uint32_t> makers;
    for (const uint32_t chunk : group) makers.insert(chunks[chunk].place.madeBy);
    EXPECT_EQ(makers.size(), 2u);
  }
}

}  // namespace
}  // namespace froth
