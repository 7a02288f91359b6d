// How kernels are laid out and what they share.
#pragma once

#include <cstdint>

#include "trainer/cuda/step_arrays.h"

namespace froth {

inline constexpr uint32_t kWarp = 32, kAllLanes = UINT32_MAX;
inline constexpr uint32_t kBlock = 256;  // threads of kernels that have no shape of their own

inline constexpr uint32_t kSmallBlock = 64;  // few threads, or work that differs by warp, spread over the GPU

inline uint32_t blocksFor(size_t threads, uint32_t size = kBlock) {
  return static_cast<uint32_t>((threads + size - 1) / size);
}

__device__ inline uint32_t globalThread() { return blockIdx.x * blockDim.x + threadIdx.x; }
__device__ inline uint32_t laneOfWarp() { return threadIdx.x % kWarp; }

// A bit mask of the lanes before this one.
__device__ inline uint32_t lanesBefore() { return (1u << laneOfWarp()) - 1; }

// Over as many neighbouring lanes, a power of two. All lanes of the warp call it.
__device__ inline float sumOfLanes(float value, uint32_t lanes) {
  for (uint32_t distance = lanes / 2; distance > 0; distance /= 2) {
    value += __shfl_xor_sync(kAllLanes, value, distance);
  }
  return value;
}

template <int kLength>
__device__ inline glm::vec<kLength, float> sumOfLanes(glm::vec<kLength, float> vector, uint32_t lanes) {
  for (int c = 0; c < kLength; ++c) vector[c] = sumOfLanes(vector[c], lanes);
  return vector;
}

__device__ inline float largestOfLanes(float value, uint32_t lanes) {
  for (uint32_t distance = lanes / 2; distance > 0; distance /= 2) {
    value = fmaxf(value, __shfl_xor_sync(kAllLanes, value, distance));
  }
  return value;
}

// Gradients that were no finite numbers.
__device__ inline void countBad(const StepArrays& arrays, uint32_t bad) {
  if (bad > 0) atomicAdd(&arrays.counters->droppedCount, bad);
}

// A step whose lists did not fit changes nothing.
__device__ inline bool isVoid(const StepArrays& arrays) { return arrays.counters->tileEntries > arrays.entryCapacity; }

}  // namespace froth
