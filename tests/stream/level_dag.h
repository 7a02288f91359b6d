// Levels of random assets, as docs/STREAMING.md defines them, without cells.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/stream/selection.h"

namespace froth::test {

struct LevelDag {
  std::vector<ChunkLevel> levels;
  std::vector<LevelGroup> groups;
  std::vector<uint64_t> bytes;
  std::vector<uint32_t> cells;
  std::vector<Box> liveBoxes;  // [chunks]
  double extent = 0;           // chunks lie in [0, extent]^2

  LevelGraph graph() const { return LevelGraph({levels, groups, bytes, cells, liveBoxes}); }
};

struct DagShape {
  uint32_t finestChunks = 64;
  uint32_t floorChunks = 3;  // at most
  uint32_t mostInGroup = 6;
};

// Chunks lie along a curve through a square. Each level groups them anew with borders drawn at random, so the coarse
// chunks of one group go into several groups of the next.
LevelDag makeLevelDag(uint64_t seed, const DagShape& shape);

// An eye somewhere in the square or near it, with a pixel that wants groups of all levels.
StreamEye makeEye(uint64_t seed, const LevelDag& dag);

}  // namespace froth::test
