// Cells, planes and details of the seen cells, relative to the eye, and zeros for what their rays will add up. Compiled
// without fused multiply-adds, so that both cells of a pair find the same plane, and the CPU does too. Bound: 24 M + 40
// bytes read per detail site (M lobes), 36 read and 32 written per plane.
#include "trainer/cuda/launch.h"
#include "trainer/cuda/passes.h"

namespace froth {
namespace {

__global__ void prepareCellsKernel(StepArrays arrays, TrainingView<float> view) {
  const uint32_t rank = globalThread();
  if (rank >= arrays.counters->seenCells) return;
  const uint32_t cell = arrays.sortedCells[rank];
  SeenCell<float> seen;
  prepareCell(arrays.foam, view, cell, seen);
  seen.planesBegin = arrays.planesBegin[rank];
  seen.planesEnd = seen.planesBegin + arrays.pairs.offsets[cell + 1] - arrays.pairs.offsets[cell];
  arrays.seen.cells[rank] = seen;
  arrays.sums.cells[rank] = {};
}

constexpr uint32_t kLanesPerRow = 8;

__global__ void preparePlanesKernel(StepArrays arrays, TrainingView<float> view) {
  const uint32_t rank = globalThread() / kLanesPerRow;
  if (rank >= arrays.counters->seenCells) return;
  const uint32_t cell = arrays.sortedCells[rank], begin = arrays.pairs.offsets[cell];
  const uint32_t count = arrays.pairs.offsets[cell + 1] - begin, planesBegin = arrays.planesBegin[rank];
  for (uint32_t i = globalThread() % kLanesPerRow; i < count; i += kLanesPerRow) {
    arrays.seen.planes[planesBegin + i] = preparePlane(arrays.foam, view, cell, arrays.pairs.neighbours[begin + i]);
    arrays.sums.pairs[planesBegin + i] = glm::vec4(0);
  }
}

__global__ void prepareDetailsKernel(StepArrays arrays) {
  const uint32_t detail = globalThread(), rank = detail / arrays.foam.shape.detailCount;
  if (rank >= arrays.counters->seenCells) return;
  arrays.seen.details[detail] =
      prepareDetail(arrays.foam, arrays.seen.cells[rank], detail % arrays.foam.shape.detailCount);
  arrays.sums.details[detail] = {};
}

}  // namespace

Status prepareCells(const StepArrays& arrays, const TrainingView<float>& view, cudaStream_t stream) {
  const size_t count = arrays.foam.shape.cellCount;
  prepareCellsKernel<<<blocksFor(count), kBlock, 0, stream>>>(arrays, view);
  preparePlanesKernel<<<blocksFor(count * kLanesPerRow), kBlock, 0, stream>>>(arrays, view);
  prepareDetailsKernel<<<blocksFor(count * arrays.foam.shape.detailCount), kBlock, 0, stream>>>(arrays);
  return checkLaunch("prepareCells");
}

}  // namespace froth
