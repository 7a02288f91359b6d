// Numbers of the cells that chunks share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/cells/chunk_plan.h"

namespace froth {

// [cellCount] a number below `count` for each cell that stands in several chunks or is a ghost of one, else kNoRef.
// Numbers ascend in the order in which cells first stand in chunks.
std::vector<CellRef> numberBorders(std::span<const PlannedChunk> chunks, std::span<const CellRows> rows,
                                   uint32_t cellCount, uint32_t& count);

}  // namespace froth
