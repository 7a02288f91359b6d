// Cells of a plan (trainer/loop/cell_plan.h) gathered from those before. Bound: bytes, each value read and written.
#include "trainer/cuda/launch.h"
#include "trainer/cuda/passes.h"
#include "trainer/step/crowds.h"

namespace froth {
namespace {

template <class T>
__global__ void gatherRowsKernel(const T* from, T* to, const uint32_t* sources, uint32_t cellCount, uint32_t width) {
  const size_t i = size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i < size_t{cellCount} * width) to[i] = from[size_t{sources[i / width]} * width + i % width];
}

__global__ void applyPlanKernel(TrainedFoam<float> foam, const glm::vec3* shifts, const float* meanFactors,
                                const float* radiusFactors) {
  const uint32_t cell = globalThread();
  if (cell >= foam.shape.cellCount) return;
  float* site = foam.values.row(Parameter::kPoints, foam.shape, cell);
  for (int c = 0; c < 3; ++c) site[c] += shifts[cell][c];
  foam.contributions[cell] *= meanFactors[cell];
  foam.errors[cell] *= meanFactors[cell];
  shrinkCell(foam.values, foam.shape, cell, radiusFactors[cell]);
}

}  // namespace

template <class T>
Status gatherRows(const T* from, T* to, const uint32_t* sources, uint32_t cellCount, uint32_t width,
                  cudaStream_t stream) {
  gatherRowsKernel<<<blocksFor(size_t{cellCount} * width), kBlock, 0, stream>>>(from, to, sources, cellCount, width);
  return checkLaunch("gatherRows");
}

template Status gatherRows(const float*, float*, const uint32_t*, uint32_t, uint32_t, cudaStream_t);
template Status gatherRows(const uint32_t*, uint32_t*, const uint32_t*, uint32_t, uint32_t, cudaStream_t);

Status applyPlan(const StepArrays& arrays, const glm::vec3* shifts, const float* meanFactors,
                 const float* radiusFactors, cudaStream_t stream) {
  applyPlanKernel<<<blocksFor(arrays.foam.shape.cellCount), kBlock, 0, stream>>>(arrays.foam, shifts, meanFactors,
                                                                                 radiusFactors);
  return checkLaunch("applyPlan");
}

}  // namespace froth
