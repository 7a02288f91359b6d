// A warp draws 8 x 4 pixels, half a tile, and ends on its own. It looks at 32 entries of the tile's list at a time and
// goes on with those that its pixels can see.
#pragma once

#include "base/result.h"
#include "trainer/cuda/launch.h"
#include "trainer/step/pixel_passes.h"
#include "trainer/step/tiles.h"

namespace froth {

inline constexpr uint32_t kWarpsPerTile = kTileSize * kTileSize / kWarp;

// Around the rays of a warp's pixels, as coneOfTile().
__device__ inline glm::vec4 coneOfWarp(const glm::vec3& direction) {
  const glm::vec3 sum = sumOfLanes(direction, kWarp);
  const float length = sqrtf(glm::dot(sum, sum));
  if (!(length > 0)) return {0, 0, 1, float(foam::kConeOfNone)};
  const glm::vec3 axis = sum / length, difference = direction - axis;
  const float squared = direction == glm::vec3(0) ? 0 : glm::dot(difference, difference);
  return foam::coneOfChord(axis, sqrtf(largestOfLanes(squared, kWarp)));
}

// The pixel of a thread. Blocks of 64 threads draw a tile.
struct WarpPixel {
  bool isInside = false;  // of the image, with a ray
  size_t pixel = 0;
  glm::vec3 direction{0};
  glm::vec4 cone;               // of the warp
  uint32_t listBegin, listEnd;  // of the tile
};

__device__ inline WarpPixel pixelOfThread(const StepArrays& arrays, const TrainingView<float>& view) {
  const uint32_t tile = arrays.tileOrder[blockIdx.x], tilesX = tilesAlong(view.width);
  const uint32_t x = tile % tilesX * kTileSize + threadIdx.x % kTileSize;
  const uint32_t y = tile / tilesX * kTileSize + threadIdx.x / kTileSize;
  WarpPixel own;
  own.isInside = x < view.width && y < view.height;
  own.pixel = size_t{y} * view.width + x;
  if (own.isInside) own.direction = directionOfPixel(view, x, y);
  own.cone = coneOfWarp(own.direction);
  own.listBegin = arrays.tilesBegin[tile];
  own.listEnd = arrays.tilesBegin[tile + 1];
  return own;
}

// Of 32 entries from `first` on, one per lane: its rank, and which of them (bits) the warp can see.
__device__ inline uint32_t lookAtEntries(const StepArrays& arrays, const glm::vec4& cone, uint32_t first, uint32_t end,
                                         uint32_t& rank) {
  const uint32_t entry = first + laneOfWarp();
  bool isSeen = false;
  rank = 0;
  if (entry < end) {
    rank = arrays.sortedRanks[entry];
    const SeenCell<float>& cell = arrays.seen.cells[rank];
    isSeen = foam::coneMeetsBall(cone, cell.centre, foam::guardedRadius(cell.centre, cell.radius));
  }
  return __ballot_sync(kAllLanes, isSeen);
}

// With the number of details known to the compiler where it is a common one.
template <class Launch>
Status withDetailCount(uint32_t detailCount, const Launch& launch) {
  return detailCount == 8 ? launch.template operator()<8>() : launch.template operator()<0>();
}

}  // namespace froth
