// Which balls of a foam overlap (docs/FOAM.md "Graphs").
#pragma once

#include <span>

#include <glm/glm.hpp>

#include "base/progress.h"
#include "foam/cell_graph.h"

namespace froth {

// Pairs with |p_i - p_j| < r_i + r_j, in double; over a bounding volume hierarchy, near-linear. All cores. When
// `progress` asks to stop the result is empty (no offsets): whoever stopped it drops it.
CellGraph findCechPairs(std::span<const glm::vec3> sites, std::span<const float> radii, const Progress& progress = {});

}  // namespace froth
