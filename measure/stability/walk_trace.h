// Walks of a view's rays on the CPU, in float as shaders/gpu/walk_steps.glsl does them, and what theory promises of
// them.
#pragma once

#include <cstdint>

#include "foam/cell_graph.h"
#include "foam/foam.h"
#include "reference/camera/camera.h"

namespace froth {

// Theory (docs/FOAM.md "Order"): a walk visits cells of strictly increasing d . p, none twice, and ends in the cell in
// which the ray leaves for infinity, that of the largest d . p. Differences below rounding of d . p count as equal.
struct WalkTrace {
  uint64_t rays = 0, steps = 0;
  uint64_t mostSteps = 0;   // of one ray; at most the number of cells
  uint64_t violations = 0;  // steps to a smaller d . p, or to a cell that was visited
  uint64_t lost = 0;        // walks that ended in another cell
};

// `graph` is that of the regular triangulation of the same cells.
WalkTrace traceWalks(const Foam& foam, const CellGraph& graph, const View& view);

}  // namespace froth
