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

// With the largest step there is: small codes.
CellNumbers toNumbers(std::span<const float> values);

// Colours in steps of step * 2^scales[i]. The codes of a colour are green, red - green, blue - green; if they
// are raw, red, green, blue. `scales` empty: all 0.
CellNumbers toColourNumbers(std::span<const glm::vec3> colours, std::span<const uint8_t> scales);

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
