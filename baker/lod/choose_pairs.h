// Which cells of a foam become one in its next level of detail.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "baker/lod/merge_cells.h"
#include "foam/foam.h"

namespace froth {

// Disjoint pairs of cells that show (density > 0), overlap and are not locked (isLocked[cell] == 0): those first whose
// merging shows least, at most `most`. `contributions`, `eyes`: as of mergePairs. O(n log n) for a bounded number of
// overlaps per cell. The same result on any number of threads.
std::vector<CellPair> choosePairs(const Foam& cells, std::span<const uint8_t> isLocked,
                                  std::span<const double> contributions, size_t most,
                                  std::span<const glm::vec3> eyes = {});

}  // namespace froth
