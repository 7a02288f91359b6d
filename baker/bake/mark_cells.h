// What each cell is in the asset. Internal to baker/bake.
#pragma once

#include <vector>

#include "baker/bake/cells.h"
#include "baker/graph/graph.h"
#include "format/asset_contents.h"

namespace froth {

std::vector<CellState> markCells(const BakeCells& cells, const RegularTriangulation& triangulation,
                                 const AlphaComplex& alpha, bool hasWalkGraph);

// All but inputCells and unseenCulled.
BakeStatistics countCells(const BakeCells& cells, const std::vector<CellState>& states,
                          const RegularTriangulation& triangulation, const AlphaComplex& alpha);

}  // namespace froth
