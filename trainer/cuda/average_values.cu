// Values of all parameters counted in their running means. Bound: bytes, 12 per value.
#include "trainer/cuda/launch.h"
#include "trainer/cuda/passes.h"
#include "trainer/step/running_mean.h"

namespace froth {
namespace {

__device__ __host__ size_t lengthOf(size_t index, const FoamShape& shape) {
  return size_t{shape.cellCount} * widthOf(static_cast<Parameter>(index), shape);
}

// A thread takes a value; those of one tensor follow those of another.
__global__ void averageValuesKernel(FoamShape shape, ParameterRows<float> values, ParameterRows<float> means,
                                    uint32_t count) {
  size_t i = size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  for (size_t index = 0; index < kParameterCount; ++index) {
    const size_t length = lengthOf(index, shape);
    if (i < length) {
      float& mean = means.tensors[index][i];
      mean = foldIntoMean(mean, values.tensors[index][i], count);
      return;
    }
    i -= length;
  }
}

}  // namespace

Status averageValues(const TrainedFoam<float>& foam, const ParameterRows<float>& means, uint32_t count,
                     cudaStream_t stream) {
  size_t valueCount = 0;
  for (size_t index = 0; index < kParameterCount; ++index) valueCount += lengthOf(index, foam.shape);
  averageValuesKernel<<<blocksFor(valueCount), kBlock, 0, stream>>>(foam.shape, foam.values, means, count);
  return checkLaunch("averageValues");
}

}  // namespace froth
