// Brings the waiting parameters of seen cells to the step before: catchUpCell(), by a warp per cell. Bound: 24 bytes
// per value of a cell that waited.
#include "trainer/cuda/launch.h"
#include "trainer/cuda/passes.h"
#include "trainer/step/cell_update.h"

namespace froth {

static __global__ void catchUpCellsKernel(StepArrays arrays, AdamStep<float> adam) {
  const uint32_t rank = globalThread() / kWarp;
  if (rank >= arrays.counters->seenCells) return;
  const uint32_t cell = arrays.sortedCells[rank];
  const uint32_t lastStep = arrays.foam.lastSteps[cell];
  if (lastStep + 1 >= adam.step) return;
  for (size_t index = 0; index < kParameterCount; ++index) {
    const auto parameter = static_cast<Parameter>(index);
    if (!isWaiting(parameter)) continue;
    const Wait<float> wait = waitSince(adam, parameter, lastStep);
    const ParameterPart<float> part = partOf(arrays.foam, parameter, cell);
    const uint32_t width = widthOf(parameter, arrays.foam.shape);
    for (uint32_t i = laneOfWarp(); i < width; i += kWarp) {
      catchUp(part.values[i], part.firstMoments[i], part.secondMoments[i], wait);
    }
  }
  __syncwarp();
  if (laneOfWarp() == 0) arrays.foam.lastSteps[cell] = adam.step - 1;
}

Status catchUpCells(const StepArrays& arrays, const AdamStep<float>& adam, cudaStream_t stream) {
  catchUpCellsKernel<<<blocksFor(size_t{arrays.foam.shape.cellCount} * kWarp), kBlock, 0, stream>>>(arrays, adam);
  return checkLaunch("catchUpCells");
}

}  // namespace froth
