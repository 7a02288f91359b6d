// A warp draws 8 x 4 pixels, half a tile, and ends on its own.
#pragma once

#include "base/result.h"
#include "trainer/cuda/launch.h"
#include "trainer/step/pixel_passes.h"
#include "trainer/step/tiles.h"

namespace froth {

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
  uint32_t listBegin, listEnd;  // of the tile
  uint32_t* metEntries;         // of the warp, kWarpsPerTile from one to the next
};

__device__ inline WarpPixel pixelOfThread(const StepArrays& arrays, const TrainingView<float>& view) {
  const uint32_t tile = arrays.tileOrder[blockIdx.x], tilesX = tilesAlong(view.width);
  const uint32_t x = tile % tilesX * kTileSize + threadIdx.x % kTileSize;
  const uint32_t y = tile / tilesX * kTileSize + threadIdx.x / kTileSize;
  WarpPixel own;
  own.isInside = x < view.width && y < view.height;
  own.pixel = size_t{y} * view.width + x;
  if (own.isInside) own.direction = directionOfPixel(view, x, y);
  own.listBegin = arrays.tilesBegin[tile];
  own.listEnd = arrays.tilesBegin[tile + 1];
  own.metEntries = arrays.metEntries + size_t{own.listBegin / kWarp + tile} * kWarpsPerTile + threadIdx.x / kWarp;
  return own;
}

// With the number of details known to the compiler where it is a common one.
template <class Launch>
Status withDetailCount(uint32_t detailCount, const Launch& launch) {
  return detailCount == 8 ? launch.template operator()<8>() : launch.template operator()<0>();
}

}  // namespace froth
