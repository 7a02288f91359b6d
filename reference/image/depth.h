// Distances along rays as files and the reference have them.
#pragma once

#include <limits>

#include "reference/image/image.h"

namespace froth {

// The runtime says +inf where transmittance never falls to the quantile, files say -1 (docs/FOAM.md). Nothing lies at a negative distance:
// that becomes NaN, so that it passes for no -1.
inline void markMissingDepth(Image& depth) {
  for (float& value : depth.values) {
    if (value == std::numeric_limits<float>::infinity()) {
      value = -1.0f;
    } else if (value < 0) {
      value = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

}  // namespace froth
