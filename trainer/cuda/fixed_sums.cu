// Sums of whole numbers become those of floats, and 0 for the next view. Bound: bytes, 20 per number.
#include "trainer/cuda/fixed_sums.h"

#include "trainer/cuda/passes.h"

namespace froth {
namespace {

__global__ void takeFixedSumsKernel(FixedNumber* fixed, float* sums, size_t count, float step) {
  const size_t i = size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= count) return;
  sums[i] = static_cast<float>(static_cast<long long>(fixed[i])) * step;
  fixed[i] = 0;
}

}  // namespace

Status takeFixedSums(const StepArrays& arrays, float perPixel, cudaStream_t stream) {
  const FixedSums& fixed = arrays.fixedSums;
  const auto take = [&](FixedNumber* from, auto* to, size_t numbers) {
    if (numbers == 0) return;
    takeFixedSumsKernel<<<blocksFor(numbers), kBlock, 0, stream>>>(from, reinterpret_cast<float*>(to), numbers,
                                                                   perPixel / kFixedSteps);
  };
  take(fixed.cells, arrays.sums.cells, fixed.cellNumbers);
  take(fixed.details, arrays.sums.details, fixed.detailNumbers);
  take(fixed.pairs, arrays.sums.pairs, fixed.pairNumbers);
  return checkLaunch("takeFixedSums");
}

}  // namespace froth
