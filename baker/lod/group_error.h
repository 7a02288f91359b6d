// How coarse the coarse form of a group is.
#pragma once

#include <cstdint>

#include "foam/foam.h"

namespace froth {

// The size of a pixel from which on `coarse` stands for `fine` [scene units].
double measureGroupError(const Foam& fine, const Foam& coarse, uint64_t seed);

}  // namespace froth
