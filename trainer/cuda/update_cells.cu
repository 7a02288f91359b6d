// Sums become gradients, and Adam takes them in the same breath. Bound: bytes. Details: 48 M + 36 read and written
// twice per seen detail site; balls: 100 per cell and 40 per pair.
#include "trainer/cuda/launch.h"
#include "trainer/cuda/passes.h"
#include "trainer/step/cell_update.h"

namespace froth {
namespace {

__device__ void countBad(const StepArrays& arrays, uint32_t bad) {
  if (bad > 0) atomicAdd(&arrays.counters->droppedCount, bad);
}

__global__ void updateDetailsKernel(StepArrays arrays, AdamStep<float> adam) {
  const uint32_t detail = globalThread(), detailCount = arrays.foam.shape.detailCount;
  const uint32_t rank = detail / detailCount;
  if (rank >= arrays.counters->seenCells || isVoid(arrays)) return;
  CellSums<float> asked;
  uint32_t bad = 0;
  updateDetail(arrays.foam, adam, arrays.seen.cells[rank], arrays.seen.details[detail], detail % detailCount,
               arrays.sums.details[detail], asked, bad);
  CellSums<float>& sums = arrays.sums.cells[rank];
  for (int c = 0; c < 3; ++c) {
    atomicAdd(&sums.site[c], asked.site[c]);
    atomicAdd(&sums.torque[c], asked.torque[c]);
  }
  atomicAdd(&sums.radius, asked.radius);
  countBad(arrays, bad);
}

__global__ void updateSeenCellsKernel(StepArrays arrays, AdamStep<float> adam) {
  const uint32_t rank = globalThread();
  if (rank >= arrays.counters->seenCells || isVoid(arrays)) return;
  uint32_t bad = 0;
  updateSeenCell(arrays.foam, adam, arrays.seen.cells[rank], arrays.sums.cells[rank], bad);
  countBad(arrays, bad);
}

__global__ void updateBallsKernel(StepArrays arrays, AdamStep<float> adam, float overlapWeight) {
  const uint32_t cell = globalThread();
  if (cell >= arrays.foam.shape.cellCount || isVoid(arrays)) return;
  uint32_t bad = 0;
  updateBall(arrays.foam, adam, cell,
             gatherBall(arrays.foam, arrays.pairs, arrays.seen, arrays.sums, overlapWeight, cell), bad);
  updateMeans(arrays.foam, arrays.seen, arrays.sums, cell);
  countBad(arrays, bad);
}

}  // namespace

Status updateCells(const StepArrays& arrays, const AdamStep<float>& adam, float overlapWeight, cudaStream_t stream) {
  const size_t count = arrays.foam.shape.cellCount;
  updateDetailsKernel<<<blocksFor(count * arrays.foam.shape.detailCount), kBlock, 0, stream>>>(arrays, adam);
  updateSeenCellsKernel<<<blocksFor(count), kBlock, 0, stream>>>(arrays, adam);
  updateBallsKernel<<<blocksFor(count), kBlock, 0, stream>>>(arrays, adam, overlapWeight);
  return checkLaunch("updateCells");
}

}  // namespace froth
