#include "runtime/asset/cell_numbers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "format/lattice.h"

namespace froth {
namespace {

constexpr int kMantissaBits = 23;
constexpr int kExponentBias = 127;

// The largest power of two of which all values are multiples; 0: there is none, or an index would be too
// large. The only zero of a lattice is +0.
float findStep(std::span<const float> values) {
  int lowest = std::numeric_limits<int>::max();
  float largest = 0;
  for (const float value : values) {
    const uint32_t bits = std::bit_cast<uint32_t>(value);
    if (bits == 0) continue;
    if (!std::isnormal(value)) return 0;
    const uint32_t mantissa = (bits & ((1u << kMantissaBits) - 1)) | 1u << kMantissaBits;
    const int exponent = static_cast<int>(bits >> kMantissaBits & 255) - kExponentBias - kMantissaBits;
    lowest = std::min(lowest, exponent + std::countr_zero(mantissa));
    largest = std::max(largest, std::abs(value));
  }
  if (largest == 0) return 1;
  const float step = std::ldexp(1.0f, lowest);
  return std::isnormal(step) && largest / step <= static_cast<float>(kMaxLatticeIndex) ? step : 0;
}

}  // namespace

CellNumbers toNumbers(std::span<const float> values) {
  CellNumbers numbers{findStep(values), {}};
  numbers.codes.reserve(values.size());
  for (const float value : values) {
    numbers.codes.push_back(numbers.isRaw() ? std::bit_cast<int32_t>(value)
                                            : static_cast<int32_t>(value / numbers.step));
  }
  return numbers;
}

CellNumbers toColourNumbers(std::span<const glm::vec3> colours, std::span<const uint8_t> scales) {
  std::vector<float> unscaled;
  unscaled.reserve(3 * colours.size());
  for (size_t i = 0; i < colours.size(); ++i) {
    const float unit = static_cast<float>(1u << (scales.empty() ? 0 : scales[i]));
    for (int c = 0; c < 3; ++c) unscaled.push_back(colours[i][c] / unit);
  }
  CellNumbers numbers = toNumbers(unscaled);
  for (size_t i = 0; i < colours.size(); ++i) {
    int32_t* code = &numbers.codes[3 * i];
    if (numbers.isRaw()) {
      for (int c = 0; c < 3; ++c) code[c] = std::bit_cast<int32_t>(colours[i][c]);
    } else {
      const std::array<int32_t, 3> separated = separateGreen(code[0], code[1], code[2]);
      std::copy(separated.begin(), separated.end(), code);
    }
  }
  return numbers;
}

void CodeRange::add(int32_t code) {
  low = std::min(low, code);
  high = std::max(high, code);
}

uint32_t CodeRange::width() const {
  return low > high ? 0
                    : static_cast<uint32_t>(std::bit_width(static_cast<uint32_t>(high) - static_cast<uint32_t>(low)));
}

uint32_t CodeRange::signedWidth() const {
  if (low > high || (low == 0 && high == 0)) return 0;
  const auto most = static_cast<uint32_t>(std::max(high, -(low + 1)));
  return 1 + static_cast<uint32_t>(std::bit_width(most));
}

}  // namespace froth
