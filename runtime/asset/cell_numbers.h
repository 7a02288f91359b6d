// A chunk's numbers as they go to the GPU: whole multiples of a step where they have one, the bits of floats
// elsewhere. Either way the shaders get the reader's floats back bit for bit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/asset_contents.h"

namespace froth {

struct CellNumbers {
  float step = 1;              // a power of two; 0: the codes are the bits of floats
  std::vector<int32_t> codes;  // value = step * code; |code| <= kMaxLatticeIndex (format/lattice.h)

  bool isRaw() const { return step == 0; }
};

// `indices` in steps of `step` (format/chunk_codes.h); none: the bits of `values`.
CellNumbers toNumbers(std::vector<int32_t> indices, float step, std::span<const float> values);

// Indices in steps of step * 2^scale of their cell. `scales`: of the chunk's cells; empty: all 0.
CellNumbers toNumbers(std::vector<int32_t> indices, float step, std::span<const float> values,
                      std::span<const uint8_t> scales);

// Of red, green, blue. The codes of a colour are green, red - green, blue - green, in steps of step * 2^scale of the
// cell; if they are raw, red, green, blue.
CellNumbers toColourNumbers(std::vector<int32_t> indices, float step, std::span<const float> values);

// The codes that some numbers of a cell take.
struct CodeRange {
  int32_t low = INT32_MAX, high = INT32_MIN;

  void add(int32_t code);
  // Bits of code - low.
  uint32_t width() const;
  // Bits of a two's complement number; all zero: none.
  uint32_t signedWidth() const;
};

}  // namespace froth
