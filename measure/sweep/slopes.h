// How errors fall and times grow: log-log slopes of a report.
#pragma once

#include <vector>

#include "measure/sweep/measure.h"

namespace froth {

// Mean error over the step of every knob that has a law. `sweeps`: of the knobs, in their order.
Result<std::vector<Slope>> errorSlopes(const Bench& bench, const Foam& foam, const std::vector<Knob>& knobs,
                                       const std::vector<Sweep>& sweeps, PointList& points);

// Frame over pixels, for raster and walk, of the default asset; frame and bake over cells, of copies of the foam side
// by side seen from outside (without a foam: pixels alone).
Result<std::vector<Slope>> timeSlopes(const Bench& bench, const FoamInput& input, bool hasFoam,
                                      const Progress& progress);

}  // namespace froth
