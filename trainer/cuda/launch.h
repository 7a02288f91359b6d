// How kernels are laid out and what they share.
#pragma once

#include <cstdint>

#include "trainer/cuda/step_arrays.h"

namespace froth {

inline constexpr uint32_t kWarp = 32, kAllLanes = UINT32_MAX;
inline constexpr uint32_t kBlock = 256;  // threads of kernels that have no shape of their own

inline uint32_t blocksFor(size_t threads) { return static_cast<uint32_t>((threads + kBlock - 1) / kBlock); }

__device__ inline uint32_t globalThread() { return blockIdx.x * blockDim.x + threadIdx.x; }
__device__ inline uint32_t laneOfWarp() { return threadIdx.x % kWarp; }

// A bit mask of the lanes before this one.
__device__ inline uint32_t lanesBefore() { return (1u << laneOfWarp()) - 1; }

// A step whose lists did not fit changes nothing.
__device__ inline bool isVoid(const StepArrays& arrays) { return arrays.counters->tileEntries > arrays.entryCapacity; }

}  // namespace froth
