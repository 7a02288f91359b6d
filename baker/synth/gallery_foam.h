// The gallery as a foam.
#pragma once

#include <cstdint>

#include "baker/foam.h"
#include "baker/progress.h"
#include "format/result.h"

namespace froth {

// At most `cellCount` cells, and within a few percent of it: surfaces take whole rows of cells. K = 8, M = 8.
// Fails with kUsage below the number of cells that the thinnest parts need.
Result<Foam> synthesizeGallery(uint32_t cellCount, uint64_t seed, const Progress& progress);

}  // namespace froth
