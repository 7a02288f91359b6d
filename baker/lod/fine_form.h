// The cells of a group as its level has them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "baker/lod/level_chunk.h"

namespace froth {

struct FineForm {
  std::vector<uint32_t> cells;    // of the scene
  std::vector<uint8_t> isLive;    // [cells]
  std::vector<uint8_t> isLocked;  // [cells] 1: has a neighbour outside
  uint32_t liveCount = 0, lockedLive = 0;
  CellRows rows;               // of the cells
  std::vector<uint32_t> ring;  // cells outside that are neighbours of some here, ascending

  std::vector<std::pair<uint32_t, uint32_t>> places;  // cell of the scene, its index here; ascending

  uint32_t count() const { return static_cast<uint32_t>(cells.size()); }
  // The index of a cell of the scene; none: it is outside.
  std::optional<uint32_t> placeOf(uint32_t cell) const;
};

// `group`: indices of chunks.
FineForm makeFineForm(std::span<const LevelChunk> chunks, std::span<const uint32_t> group);

}  // namespace froth
