// What a scene does not need and its asset does not hold. Internal to baker/bake.
#pragma once

#include <cstdint>
#include <vector>

#include "baker/bake/bake.h"
#include "foam/foam.h"

namespace froth {

// Counted while chunks are made.
struct StoredCounts {
  uint64_t cells = 0, live = 0;
  uint64_t detailHeights = 0, lobes = 0;
};

std::vector<LeftOut> listLeftOut(const Foam& foam, const AssetContents& contents, const StoredCounts& stored);

}  // namespace froth
