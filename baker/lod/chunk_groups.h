// Chunks that become coarser together.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "baker/lod/level_chunk.h"

namespace froth {

// Splits the listed chunks into groups of about `groupLive` live cells that have many pairs of neighbours in common,
// rather with chunks that other groups made: borders that were locked in the level below come to lie inside. Groups
// most of whose cells would be locked are shared among their neighbours. `cellCount`: of the scene. Each chunk is in
// one group; the order is a function of the input alone.
std::vector<std::vector<uint32_t>> groupChunks(std::span<const LevelChunk> chunks, std::span<const uint32_t> listed,
                                               uint32_t cellCount, uint64_t groupLive);

}  // namespace froth
