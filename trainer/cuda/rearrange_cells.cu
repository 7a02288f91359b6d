// Cells of a plan (trainer/loop/cell_plan.h) gathered from those before. Bound: bytes, each value read and written.
#include "trainer/cuda/launch.h"
#include "trainer/cuda/passes.h"

namespace froth {
namespace {

template <class T>
__global__ void gatherRowsKernel(const T* from, T* to, const uint32_t* sources, uint32_t cellCount, uint32_t width) {
  const size_t i = size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i < size_t{cellCount} * width) to[i] = from[size_t{sources[i / width]} * width + i % width];
}

__global__ void changeCellsKernel(TrainedFoam<float> foam, const CellChange* changes) {
  const uint32_t cell = globalThread();
  if (cell < foam.shape.cellCount) changeCell(foam, cell, changes[cell]);
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

Status changeCells(const StepArrays& arrays, const CellChange* changes, cudaStream_t stream) {
  changeCellsKernel<<<blocksFor(arrays.foam.shape.cellCount), kBlock, 0, stream>>>(arrays.foam, changes);
  return checkLaunch("changeCells");
}

}  // namespace froth
