// Two cells become one.
#pragma once

#include <cstdint>
#include <span>

#include "foam/foam.h"

namespace froth {

// Indices of a foam's cells.
struct CellPair {
  uint32_t first, second;
};

// One merged cell per pair, in the order of pairs. `contributions` [cells]: how much each shows; empty: all alike.
Foam mergePairs(const Foam& cells, std::span<const CellPair> pairs, std::span<const double> contributions);

}  // namespace froth
