// Takes out what no camera sees. Internal to baker/bake.
#pragma once

#include <cstdint>
#include <span>

#include "baker/cells/cells.h"
#include "base/progress.h"

namespace froth {

// Cells whose `contributions` [cells] are not above `limit` lose their place; those whose ball overlaps the ball of a
// seen cell stay as cutters (isUnseen), so that no seen cell grows. Returns how many were culled, cutters included; the
// cells are unfinished when `progress` asked to stop.
uint64_t cullUnseenCells(BakeCells& cells, std::span<const float> contributions, float limit, const Progress& progress);

}  // namespace froth
