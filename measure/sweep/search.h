// Several knobs at once: a random search around the points that no other beats.
#pragma once

#include <chrono>
#include <vector>

#include "measure/sweep/measure.h"

namespace froth {

// Adds and measures configurations for about `seconds`, some at a time. Which ones follows from the seed and from what
// was measured.
Status searchJointly(const Bench& bench, const std::vector<Knob>& knobs, double seconds, uint64_t seed,
                     PointList& points, const Progress& progress);

}  // namespace froth
