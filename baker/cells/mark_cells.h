// What each cell is in the asset. Internal to the baker.
#pragma once

#include <vector>

#include "baker/cells/cells.h"
#include "baker/graph/graph.h"
#include "format/asset_contents.h"

namespace froth {

// Of a cell of a triangulation: whether that hides it, and whether its bounded cell is empty.
CellState stateOf(const BakeCells& cells, uint32_t cell, bool isHidden, bool isEmpty);

std::vector<CellState> markCells(const BakeCells& cells, const RegularTriangulation& triangulation,
                                 const AlphaComplex& alpha, bool hasWalkGraph);

// All but inputCells and unseenCulled.
BakeStatistics countCells(const BakeCells& cells, const std::vector<CellState>& states,
                          const RegularTriangulation& triangulation, const AlphaComplex& alpha);

}  // namespace froth
