// Levels of detail of the asset that a report is of.
#pragma once

#include <vector>

#include "measure/sweep/measure.h"

namespace froth {

// Draws the asset with all of its finest cells, gives that to `references`, those of `bench`, and returns the knobs
// whose values follow from what it takes. None of an asset without levels.
Result<std::vector<Knob>> prepareLevels(const Bench& bench, SweepReferences& references, const Progress& progress);

}  // namespace froth
