// Balls of the step that comes, and whether they still fit the pairs. Bound: 36 bytes read and 16 written per cell.
#include "trainer/cuda/launch.h"
#include "trainer/cuda/passes.h"
#include "trainer/step/skin.h"

namespace froth {

static __global__ void activateCellsKernel(StepArrays arrays, bool hasPairs) {
  const uint32_t cell = globalThread();
  if (cell >= arrays.foam.shape.cellCount) return;
  const glm::vec4 ball = ballOf(arrays.foam, cell);
  arrays.foam.balls[cell] = ball;
  if (hasPairs && !isWithinSlack(ball, arrays.foundBalls[cell], arrays.slacks[cell])) {
    arrays.counters->cellsOutOfSkin = 1;
  }
}

Status activateCells(const StepArrays& arrays, bool hasPairs, cudaStream_t stream) {
  cudaMemsetAsync(&arrays.counters->cellsOutOfSkin, 0, sizeof(uint32_t), stream);
  activateCellsKernel<<<blocksFor(arrays.foam.shape.cellCount), kBlock, 0, stream>>>(arrays, hasPairs);
  return checkLaunch("activateCells");
}

}  // namespace froth
