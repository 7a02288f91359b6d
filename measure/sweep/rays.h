// What rays from anywhere cost in the default's asset: by kind, by what is prepared for them, and what cheaper colours
// leave out.
#pragma once

#include <vector>

#include "measure/sweep/measure.h"

namespace froth {

// On devices of its own, which cast rays. The bench walks.
Result<std::vector<RayCost>> rayCosts(const Bench& bench, GpuDeviceOptions device, const Progress& progress);

}  // namespace froth
