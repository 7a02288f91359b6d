// The mean of a parameter's values after several steps, one value at a time (Welford 1962, "Note on a Method for
// Calculating Corrected Sums of Squares and Products").
//
// Raw values are averaged, as they are stored. All of them may be: a raw density or radius is the activated one, but
// near 0; places and heights of detail sites, axes and colours of lobes have no bounds; quaternions have any length
// [> 0], and turn by so little in the last tenth of a run that their mean is far from 0 (docs/notes/training.md).
//
// Values that wait (trained_cell.h) count as the last step left them that showed their cell: what they have yet to move
// by is what is left of their momentum, some ten steps of it.
#pragma once

#include <cstdint>

#include "trainer/step/host_device.h"

namespace froth {

// count: of values, this one too. No product is added, so the CPU and CUDA round alike.
template <class Real>
FROTH_HD Real foldIntoMean(Real mean, Real value, uint32_t count) {
  return count == 1 ? value : mean + (value - mean) / Real(count);
}

}  // namespace froth
