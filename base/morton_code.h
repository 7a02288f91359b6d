// The Z-order curve.
#pragma once

#include <array>
#include <cstdint>

namespace froth {

// Bit b of value goes to bit 3 b; value < 2^21.
constexpr uint64_t spreadBits(uint64_t value) {
  value = (value | value << 32) & 0x001f00000000ffffULL;
  value = (value | value << 16) & 0x001f0000ff0000ffULL;
  value = (value | value << 8) & 0x100f00f00f00f00fULL;
  value = (value | value << 4) & 0x10c30c30c30c30c3ULL;
  return (value | value << 2) & 0x1249249249249249ULL;
}
constexpr uint32_t gatherBits(uint64_t code) {
  code &= 0x1249249249249249ULL;
  code = (code | code >> 2) & 0x10c30c30c30c30c3ULL;
  code = (code | code >> 4) & 0x100f00f00f00f00fULL;
  code = (code | code >> 8) & 0x001f0000ff0000ffULL;
  code = (code | code >> 16) & 0x001f00000000ffffULL;
  return static_cast<uint32_t>((code | code >> 32) & 0x1fffff);
}

// Place of a point on the Z-order curve; x has the lowest bit. Coordinates < 2^21.
constexpr uint64_t mortonCode(const std::array<uint32_t, 3>& point) {
  return spreadBits(point[0]) | spreadBits(point[1]) << 1 | spreadBits(point[2]) << 2;
}
constexpr std::array<uint32_t, 3> mortonPoint(uint64_t code) {
  return {gatherBits(code), gatherBits(code >> 1), gatherBits(code >> 2)};
}

}  // namespace froth
