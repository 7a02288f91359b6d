// Cells of the input and merged ones in one foam.
#pragma once

#include <cstdint>
#include <span>

#include "foam/foam.h"

namespace froth {

// The listed cells, in order; `sources` as in BakeCells.
Foam gatherCells(const Foam& input, const Foam& merged, std::span<const uint32_t> sources);

}  // namespace froth
