// Balls at the beginning of a step. Bound: 16 bytes read and 16 written per cell.
#include "trainer/cuda/launch.h"
#include "trainer/cuda/passes.h"

namespace froth {

static __global__ void activateCellsKernel(StepArrays arrays) {
  const uint32_t cell = globalThread();
  if (cell < arrays.foam.shape.cellCount) arrays.foam.balls[cell] = ballOf(arrays.foam, cell);
}

Status activateCells(const StepArrays& arrays, cudaStream_t stream) {
  activateCellsKernel<<<blocksFor(arrays.foam.shape.cellCount), kBlock, 0, stream>>>(arrays);
  return checkLaunch("activateCells");
}

}  // namespace froth
