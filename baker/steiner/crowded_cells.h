// Steiner cells where cells in open space have too many neighbours.
#pragma once

#include <span>
#include <vector>

#include "baker/steiner/steiner.h"
#include "foam/cell_graph.h"

namespace froth {

// A cell that holds the air of a room touches the cells of all walls, the more the finer these are: a step through it
// asks each of its neighbours, and a file holds 65,535 of a cell at most. Steiner cells are chosen where rays pass, so
// some such cells remain. The balls that this finds share what cells with more than 1,024 neighbours hold. Then the
// graph has to be found anew, and asked again: a few rounds suffice.
//
// `sites` and `radii` are those of the graph: first the `realCount` [>= 1] that Steiner balls may not meet, then
// Steiner cells. `round` tells the random numbers of rounds apart. None where no ball fits, as outside of the scene.
// The same input gives the same cells on any number of threads; walk lengths are not set.
SteinerCells splitCrowdedCells(std::span<const glm::vec3> sites, std::span<const float> radii, size_t realCount,
                               const CellGraph& graph, const SteinerOptions& options, uint32_t round);

}  // namespace froth
