// Small foams and views drawn where renderers break: every array from a mixture of ordinary values and of the limits
// that the built-in cases take one at a time, so that limits meet.
#pragma once

#include <cstdint>

#include "measure/stability/cases/stiff_case.h"

namespace froth {

// 2 to 40 cells, one or two views of at most 32 x 24 pixels; in some, 2 to 4 instances, ends of rays, jitter, fewer
// layers or small chunks. A pure function of the seed; every case can be baked and rendered.
StiffCase drawCase(uint64_t seed);

}  // namespace froth
