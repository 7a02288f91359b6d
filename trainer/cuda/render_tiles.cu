// Draws the image: each warp goes through its tile's list front to back until its pixels are saturated, and notes which
// entries some ray of it met. Bound: flops, some 30 per ball, 7 per plane and 25 per detail site that a ray meets.
#include "trainer/cuda/passes.h"
#include "trainer/cuda/staged_cells.h"

namespace froth {
namespace {

constexpr uint32_t kBlocksAtATime = 16;  // of a multiprocessor: 64 registers a thread in place of 80 keep more warps

// One cell of one ray, as trainer/cpu/tile_row.cpp takes it. Whether the ray met it.
__device__ bool addCell(const CellAtHand& at, uint32_t detailCount, const glm::vec3& direction, float sharpness,
                        glm::vec3& colour, float& logTransmittance) {
  Segment<float> segment;
  if (!meetCell(at.cell, at.planes, at.details, detailCount, direction, sharpness, segment)) return false;
  const float opticalDepth = at.cell.density * (segment.far - segment.near);
  colour += expf(logTransmittance) * foam::opacity(opticalDepth) * segment.colour;
  logTransmittance -= opticalDepth;
  return true;
}

template <uint32_t kDetails>
__global__ __launch_bounds__(kTileSize* kTileSize,
                             kBlocksAtATime) void renderTilesKernel(StepArrays arrays, TrainingView<float> view,
                                                                    PixelSettings<float> settings) {
  __shared__ CellStage<kDetails> stages[kWarpsPerTile];
  if (isVoid(arrays)) return;
  const uint32_t detailCount = arrays.foam.shape.detailCount;  // kDetails would unroll loops, and take registers
  CellStage<kDetails>& stage = stages[threadIdx.x / kWarp];
  const CellLane lane = CellLane::of<kDetails>(arrays.seen);
  const WarpPixel own = pixelOfThread(arrays, view);
  const glm::vec4 cone = coneOfWarp(own.direction);
  const float logCutoff = logf(settings.cutoff);
  glm::vec3 colour(0);
  float logTransmittance = 0;
  bool isLive = own.direction != glm::vec3(0);
  uint32_t end = isLive ? own.listEnd - own.listBegin : 0;
  for (uint32_t first = own.listBegin; first < own.listEnd && __any_sync(kAllLanes, isLive); first += kWarp) {
    uint32_t met = 0;
    const uint32_t count = stageEntries<false>(arrays, first, own.listEnd, stage, [&](const SeenCell<float>& cell) {
      return foam::coneMeetsBall(cone, cell.centre, foam::guardedRadius(cell.centre, cell.radius));
    });
    visitCells(arrays.seen, lane, count, detailCount, stage, [&](const CellAtHand& at) {
      if (isLive) {
        const bool isMet = addCell(at, detailCount, own.direction, settings.sharpness, colour, logTransmittance);
        if (isMet) met |= 1u << (at.place - first);
        isLive = logTransmittance >= logCutoff;
        if (!isLive) end = at.place + 1 - own.listBegin;
      }
      return __any_sync(kAllLanes, isLive) != 0;
    });
    met = __reduce_or_sync(kAllLanes, met);
    if (laneOfWarp() == 0) own.metEntries[size_t{(first - own.listBegin) / kWarp} * kWarpsPerTile] = met;
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
