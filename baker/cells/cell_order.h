// The order of cells inside a chunk. Internal to the baker.
#pragma once

#include <cstdint>
#include <span>

#include "baker/cells/cells.h"

namespace froth {

// Puts both runs of a chunk's cells along a Morton curve, or, where positions on a lattice get smaller by it, into
// Draco's order. The order of the live cells knows nothing of the others. positionStep 0: no lattice.
void orderCells(std::span<uint32_t> live, std::span<uint32_t> others, const BakeCells& cells, double positionStep);

}  // namespace froth
