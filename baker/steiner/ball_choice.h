// A choice of Steiner cells by what they save.
#pragma once

#include <span>
#include <vector>

#include "baker/steiner/empty_balls.h"
#include "baker/steiner/ray_cells.h"
#include "baker/steiner/steps.h"
#include "baker/steiner/walk_length.h"

namespace froth {

// Greedy: always the ball that makes the walks along the rays shorter by the most cells, as long as it saves
// enough. `walks` are the cells along the rays, and get the chosen ones. In the order of choice; incomplete
// when `steps` are stopped.
std::vector<EmptyBall> chooseBalls(std::span<const EmptyBall> balls, std::span<const WalkRay> rays,
                                   std::span<RayCells> walks, Steps& steps);

}  // namespace froth
