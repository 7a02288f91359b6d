// What drawing an asset will cost, roughly, before a GPU sees it.
#pragma once

#include <cstdint>

#include "format/asset_contents.h"

namespace froth {

struct CostEstimate {
  uint32_t eyes = 0, rays = 0;  // rays towards random live cells
  double meanBalls = 0;         // of live cells over a ray, near limits left aside: what a pixel may have to blend
  uint32_t mostBalls = 0;
  uint32_t longestRow = 0;      // neighbours of a cell: what a step of a walk looks at
  uint64_t squaredDegrees = 0;  // largest sum over a chunk's cells (FORMAT.md, "Limits")
};

// Eyes are the asset's start view and flight path, or six about the scene where it has none. `contents` holds all its
// chunks and has passed the reader's checks. The same contents give the same estimate.
CostEstimate estimateCost(const AssetContents& contents);

}  // namespace froth
