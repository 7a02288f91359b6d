// Two neighbouring cells become one that looks like both from some distance: the step from a level of detail to the
// next.
#pragma once

#include <cstdint>
#include <span>

#include "foam/foam.h"

namespace froth {

// Indices of a foam's cells.
struct CellPair {
  uint32_t first, second;
};

// One merged cell per pair, in the order of the pairs, with as many detail sites and lobes as the cells have. `cells`
// holds the neighbours too that cut a cell of a pair. `contributions`: [cells] how much each shows, the sum of T alpha
// over views; empty: all alike. `eyes`: from where the foam is seen [scene units], some dozens serve; the colours of
// merged cells fit there and over the hemisphere before each face; empty: there alone. A foam without heights
// gets none. All cores; the same result on any number of them.
Foam mergePairs(const Foam& cells, std::span<const CellPair> pairs, std::span<const double> contributions,
                std::span<const glm::vec3> eyes = {});

}  // namespace froth
