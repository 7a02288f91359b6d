// The seen cells and their planes, relative to the eye, and zeros for what their rays will add up. Compiled without
// fused multiply-adds, so that both cells of a pair find the same plane, and the CPU does too. Bound: per pair 56 bytes
// read and 16 written, and some 40 flops for each of up to 32 planes that may remove it.
#include "trainer/cuda/launch.h"
#include "trainer/cuda/passes.h"
#include "trainer/step/plane_filter.h"

namespace froth {
namespace {

__global__ void prepareCellsKernel(StepArrays arrays, TrainingView<float> view, AdamStep<float> adam) {
  const uint32_t rank = globalThread();
  if (rank >= arrays.counters->seenCells) return;
  SeenCell<float> seen;
  prepareCell(TrainedCell<float>(arrays.foam, adam, arrays.sortedCells[rank]), view.eye, seen);
  arrays.seen.cells[rank] = seen;
  arrays.sums.cells[rank] = {};
}

__device__ LocalPlane<float> planeOfLane(const LocalPlane<float>& own, int lane) {
  LocalPlane<float> plane;
  for (int c = 0; c < 3; ++c) plane.toNeighbour[c] = __shfl_sync(kAllLanes, own.toNeighbour[c], lane);
  plane.offset = __shfl_sync(kAllLanes, own.offset, lane);
  plane.squaredLength = __shfl_sync(kAllLanes, own.squaredLength, lane);
  plane.rounding = __shfl_sync(kAllLanes, own.rounding, lane);
  return plane;
}

// The planes of a cell, of which each lane has every 32nd.
struct CellPlanes {
  glm::vec4 ball;
  const uint32_t* neighbours;
  uint32_t count;
  const glm::vec4* balls;

  __device__ LocalPlane<float> at(uint32_t i) const { return localPlane(ball, balls[neighbours[i]]); }
};

// The plane of each lane that cuts its ball deepest: good removers of others. place: which it is; none: the count.
struct DeepPlane {
  LocalPlane<float> plane;
  uint32_t place;
  bool isHiding = false;
};

__device__ DeepPlane deepestOfLane(const CellPlanes& planes) {
  DeepPlane deepest;
  deepest.place = planes.count;
  float least = INFINITY;
  for (uint32_t i = laneOfWarp(); i < planes.count; i += kWarp) {
    const LocalPlane<float> plane = planes.at(i);
    const float depth = plane.offset * rsqrtf(plane.squaredLength);
    if (missesBall(plane, planes.ball.w) || !(depth < least)) continue;
    least = depth;
    deepest = {plane, i, hidesBall(plane, planes.ball.w)};
  }
  return deepest;
}

// All lanes call it. Whether plane i bounds the cell, as far as the lanes' deepest planes tell.
__device__ bool isKept(const CellPlanes& planes, uint32_t i, const DeepPlane& deepest, uint32_t removers) {
  LocalPlane<float> plane;
  bool isKept = i < planes.count;
  if (isKept) {
    plane = planes.at(i);
    isKept = !missesBall(plane, planes.ball.w);
  }
  for (; removers != 0; removers &= removers - 1) {
    const int lane = __ffs(static_cast<int>(removers)) - 1;
    const LocalPlane<float> remover = planeOfLane(deepest.plane, lane);
    const uint32_t place = __shfl_sync(kAllLanes, deepest.place, lane);
    isKept = isKept && (i == place || !isRemovedBy(plane, remover, planes.ball.w));
  }
  return isKept;
}

// A warp per cell. Planes that bound it (trainer/step/plane_filter.h) go to the beginning of its row.
__global__ void preparePlanesKernel(StepArrays arrays, TrainingView<float> view) {
  const uint32_t rank = globalThread() / kWarp;
  if (rank >= arrays.counters->seenCells) return;
  const uint32_t cell = arrays.sortedCells[rank], begin = arrays.pairs.offsets[cell];
  const uint32_t rowBegin = arrays.planesBegin[rank];
  const CellPlanes planes{arrays.foam.balls[cell], arrays.pairs.neighbours + begin,
                          arrays.pairs.offsets[cell + 1] - begin, arrays.foam.balls};
  const DeepPlane deepest = deepestOfLane(planes);
  const uint32_t removers = __ballot_sync(kAllLanes, deepest.place < planes.count);
  const uint32_t hiders = __ballot_sync(kAllLanes, deepest.isHiding);
  // One plane that hides the cell is as good as all.
  const uint32_t hider = __shfl_sync(kAllLanes, deepest.place, hiders != 0 ? __ffs(static_cast<int>(hiders)) - 1 : 0);
  uint32_t kept = 0;
  for (uint32_t first = 0; first < planes.count; first += kWarp) {
    const uint32_t i = first + laneOfWarp();
    const bool keeps = hiders != 0 ? i == hider : isKept(planes, i, deepest, removers);
    const uint32_t keeping = __ballot_sync(kAllLanes, keeps);
    if (i < planes.count) arrays.sums.pairs[rowBegin + i] = glm::vec4(0);
    if (keeps) {
      const uint32_t plane = rowBegin + kept + __popc(keeping & lanesBefore());
      arrays.seen.planes[plane] = preparePlane(arrays.foam, view, cell, planes.neighbours[i]);
      arrays.pairOfPlane[plane] = rowBegin + i;
    }
    kept += __popc(keeping);
  }
  if (laneOfWarp() == 0) {
    arrays.seen.cells[rank].planesBegin = rowBegin;
    arrays.seen.cells[rank].planesEnd = rowBegin + kept;
  }
}

}  // namespace

Status prepareCells(const StepArrays& arrays, const TrainingView<float>& view, const AdamStep<float>& adam,
                    cudaStream_t stream) {
  const size_t count = arrays.foam.shape.cellCount;
  prepareCellsKernel<<<blocksFor(count), kBlock, 0, stream>>>(arrays, view, adam);
  preparePlanesKernel<<<blocksFor(count * kWarp), kBlock, 0, stream>>>(arrays, view);
  return checkLaunch("prepareCells");
}

}  // namespace froth
