// Sums that do not depend on the order in which warps add: of whole numbers in place of floats.
#pragma once

#include <cstdint>

#include "trainer/cuda/launch.h"
#include "trainer/step/pixel_passes.h"

namespace froth {

inline constexpr float kFixedSteps = 1 << 30;  // of FixedNumber
// What a warp adds at once is cut to this; seven such sums still fit.
inline constexpr float kMostFixed = static_cast<float>(uint64_t{1} << 60);

// Where the rays of a view add up, as numbers one after the other: floats or FixedNumbers.
template <class Number>
struct SumTarget {
  Number *cells, *details, *pairs;  // GradientSums
  float scale;                      // of FixedNumbers
};

template <class Number>
__device__ SumTarget<Number> targetOfSums(const StepArrays& arrays, const PixelSettings<float>& settings);

template <>
__device__ inline SumTarget<float> targetOfSums(const StepArrays& arrays, const PixelSettings<float>&) {
  return {reinterpret_cast<float*>(arrays.sums.cells), reinterpret_cast<float*>(arrays.sums.details),
          reinterpret_cast<float*>(arrays.sums.pairs), 1};
}

template <>
__device__ inline SumTarget<FixedNumber> targetOfSums(const StepArrays& arrays, const PixelSettings<float>& settings) {
  return {arrays.fixedSums.cells, arrays.fixedSums.details, arrays.fixedSums.pairs, kFixedSteps / settings.perPixel};
}

__device__ inline void addTo(float* sum, float value, float) { atomicAdd(sum, value); }
__device__ inline void addTo(FixedNumber* sum, float value, float scale) {
  const float steps = fminf(fmaxf(value * scale, -kMostFixed), kMostFixed);
  atomicAdd(sum, static_cast<FixedNumber>(__float2ll_rn(steps)));
}

}  // namespace froth
