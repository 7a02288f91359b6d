// Distances along rays as files and the reference have them.
#pragma once

#include <limits>

#include "base/image/image.h"

namespace froth {

// The runtime says +inf where transmittance never falls to the quantile, files say -1 (docs/FOAM.md). Nothing lies at a
// negative distance: that becomes NaN, so that it passes for no -1.
inline void markMissingDistances(Image& distances) {
  for (float& value : distances.values) {
    if (value == std::numeric_limits<float>::infinity()) {
      value = -1.0f;
    } else if (value < 0) {
      value = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

}  // namespace froth
