// Draws the image: each warp goes through its tile's list front to back until its pixels are saturated. Bound: flops,
// some 30 per ball, 7 per plane and 25 per detail site that a ray meets; what is read stays in L1 for the warp.
#include "trainer/cuda/passes.h"
#include "trainer/cuda/warp_pixels.h"

namespace froth {
namespace {

constexpr uint32_t kBlocksAtATime = 16;  // of a multiprocessor: 64 registers a thread in place of 80 keep more warps

// One cell of one ray, as trainer/cpu/tile_row.cpp takes it.
__device__ void addCell(const SeenCells<float>& seen, uint32_t rank, uint32_t detailCount, const glm::vec3& direction,
                        float sharpness, glm::vec3& colour, float& logTransmittance) {
  const SeenCell<float> cell = seen.cells[rank];
  Segment<float> segment;
  if (!meetCell(cell, seen.planes, seen.details + size_t{rank} * detailCount, detailCount, direction, sharpness,
                segment)) {
    return;
  }
  const float opticalDepth = cell.density * (segment.far - segment.near);
  colour += expf(logTransmittance) * foam::opacity(opticalDepth) * segment.colour;
  logTransmittance -= opticalDepth;
}

template <uint32_t kDetails>
__global__ __launch_bounds__(kTileSize* kTileSize,
                             kBlocksAtATime) void renderTilesKernel(StepArrays arrays, TrainingView<float> view,
                                                                    PixelSettings<float> settings) {
  if (isVoid(arrays)) return;
  const uint32_t detailCount = kDetails > 0 ? kDetails : arrays.foam.shape.detailCount;
  const WarpPixel own = pixelOfThread(arrays, view);
  const float logCutoff = logf(settings.cutoff);
  glm::vec3 colour(0);
  float logTransmittance = 0;
  bool isLive = own.direction != glm::vec3(0);
  uint32_t end = isLive ? own.listEnd - own.listBegin : 0;
  for (uint32_t first = own.listBegin; first < own.listEnd && __any_sync(kAllLanes, isLive); first += kWarp) {
    uint32_t rankOfLane;
    uint32_t seen = lookAtEntries(arrays, own.cone, first, own.listEnd, rankOfLane);
    for (; seen != 0; seen &= seen - 1) {
      const int source = __ffs(static_cast<int>(seen)) - 1;
      const uint32_t rank = __shfl_sync(kAllLanes, rankOfLane, source);
      if (!isLive) continue;
      addCell(arrays.seen, rank, detailCount, own.direction, settings.sharpness, colour, logTransmittance);
      isLive = logTransmittance >= logCutoff;
      if (!isLive) end = first + source + 1 - own.listBegin;
    }
  }
  if (!own.isInside) return;
  arrays.pixels.rendered[own.pixel] = glm::vec4(colour, expf(logTransmittance));
  arrays.pixels.logTransmittances[own.pixel] = logTransmittance;
  arrays.pixels.ends[own.pixel] = end;
}

}  // namespace

Status renderTiles(const StepArrays& arrays, const TrainingView<float>& view, const PixelSettings<float>& settings,
                   cudaStream_t stream) {
  const uint32_t tileCount = tilesAlong(view.width) * tilesAlong(view.height);
  return withDetailCount(arrays.foam.shape.detailCount, [&]<uint32_t kDetails>() -> Status {
    renderTilesKernel<kDetails><<<tileCount, kTileSize * kTileSize, 0, stream>>>(arrays, view, settings);
    return checkLaunch("renderTiles");
  });
}

}  // namespace froth
