// Which cells of a group merge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "baker/lod/merge_cells.h"
#include "foam/foam.h"

namespace froth {

// Disjoint pairs of cells that may merge (isLocked[cell] == 0), best first, at most `most`. `contributions` as in
// mergePairs.
std::vector<CellPair> choosePairs(const Foam& cells, std::span<const uint8_t> isLocked,
                                  std::span<const double> contributions, size_t most);

}  // namespace froth
