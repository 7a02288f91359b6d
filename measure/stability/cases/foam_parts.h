// A foam with fewer cells, detail sites or lobes.
#pragma once

#include <cstdint>
#include <span>

#include "foam/foam.h"

namespace froth {

// Cell k of the result is cell cells[k].
Foam keepCells(const Foam& foam, std::span<const uint32_t> cells);

// The first detail sites of every cell, the first lobes of every one of them. details: 1 to the foam's; lobes: 0 to the
// foam's.
Foam keepDetails(const Foam& foam, uint32_t details, uint32_t lobes);

}  // namespace froth
