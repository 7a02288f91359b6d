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
// one group; the order is a function of the input alone. `listed`, and each group: ascending.
std::vector<std::vector<uint32_t>> groupChunks(std::span<const LevelChunk> chunks, std::span<const uint32_t> listed,
                                               uint32_t cellCount, uint64_t groupLive);

// The same groups, but that each chunk of the `dissolved` (indices of `groups`) goes to a neighbouring group with room.
// A chunk without one stays where it is.
std::vector<std::vector<uint32_t>> dissolveGroups(std::span<const LevelChunk> chunks,
                                                  std::span<const std::vector<uint32_t>> groups,
                                                  std::span<const uint32_t> dissolved, uint32_t cellCount,
                                                  uint64_t groupLive);

}  // namespace froth
