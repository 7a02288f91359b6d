// Between lattice indices and the elements of sections: what the two halves of chunk_sections share.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "format/deltas.h"
#include "format/quantization.h"

namespace froth {

// Indices of values lie within +-kMaxLatticeIndex, so that step * index is an exact float.
inline constexpr int32_t kMaxLatticeIndex = (1 << 24) - 1;

inline constexpr uint8_t kMaxScale = 15;

// Signed indices as small unsigned elements.
inline uint32_t zigzag(int32_t value) { return foldDelta(static_cast<uint32_t>(value)); }
inline int32_t unzigzag(uint32_t element) { return static_cast<int32_t>(unfoldDelta(element)); }

// The channels of a colour rise and fall together: green is stored as it is, red and blue as differences to it, in this
// order.
template <class Number>
std::array<Number, 3> separateGreen(Number red, Number green, Number blue) {
  return {green, static_cast<Number>(red - green), static_cast<Number>(blue - green)};
}
template <class Number>
std::array<Number, 3> joinGreen(Number green, Number redLess, Number blueLess) {
  return {static_cast<Number>(redLess + green), green, static_cast<Number>(blueLess + green)};
}

// Cell colours are bytes.
inline float colourOfByte(uint8_t byte) { return static_cast<float>(byte) / 255.0f; }

// The step of a lattice in a cell. `scales`: of the chunk's cells; empty: all 0.
inline float unitOf(float step, std::span<const uint8_t> scales, size_t cell) {
  return scales.empty() ? step : std::ldexp(step, scales[cell]);
}

// The index of a detail site's height that its cell's height, on the lattice of scale 0, lets expect; ties to even.
inline int32_t expectedHeightIndex(int32_t cellHeight, float heightStep, float unit) {
  return static_cast<int32_t>(std::nearbyint(double{heightStep} * cellHeight / unit));
}

// The index of a base colour that the cell's colour lets expect; ties to even.
inline int32_t expectedColourIndex(uint8_t cellColour, float unit) {
  const double index = std::nearbyint((cellColour / 255.0 - 0.5) / unit);
  return static_cast<int32_t>(std::fmin(std::fmax(index, -kMaxLatticeIndex), kMaxLatticeIndex));
}

}  // namespace froth
