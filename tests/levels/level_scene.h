// A foam with levels of detail, small and exact: all levels have the same cells, and each its own colours and
// densities, so that an image shows which level stands where.
#pragma once

#include <cstdint>
#include <vector>

#include "format/asset_contents.h"

namespace froth::test {

// Chunk 0 is the floor, level 2, without a neighbour. Level 1: chunks 1 to 4, all in one group. Level 0: two chunks for
// each of those, 5 + 2i and 6 + 2i below 1 + i.
struct LevelScene {
  AssetContents whole[3];  // [level] all cells in one chunk
  AssetContents levels;
  // [chunk of `levels`][local index] cell of `whole`
  std::vector<std::vector<uint32_t>> cells;

  static constexpr uint32_t kCoarseChunks = 4;
  std::vector<uint32_t> floor() const { return {0}; }
  // With so many bits: those of the groups of level 0 that are refined.
  std::vector<uint32_t> cut(uint32_t refined) const;
  // One chunk with the cells of a cut: what it should look like.
  AssetContents mixed(const std::vector<uint32_t>& chunks) const;
};

// Cells in [-1, 1]^3 + (0, 0, 3).
const LevelScene& levelScene();

}  // namespace froth::test
