// Which chunks are level l of an asset: the cut in which exactly the groups of level l and above are refined. Level 0
// is the scene in full. Each of them is a whole foam. docs/STREAMING.md
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "format/asset_contents.h"

namespace froth {

// A floor chunk stands for itself in all coarser levels too.
inline bool isInLevel(const ChunkLevel& chunk, uint32_t level) {
  return chunk.level == level || (chunk.in == kNoGroup && chunk.level < level);
}

// 1 without levels.
inline uint32_t countLevels(std::span<const ChunkLevel> chunks) {
  uint32_t highest = 0;
  for (const ChunkLevel& chunk : chunks) highest = std::max(highest, chunk.level);
  return highest + 1;
}

}  // namespace froth
