#include "runtime/asset/cell_numbers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "format/lattice.h"

namespace froth {
namespace {

// Zeros need no bits.
CellNumbers rawNumbers(std::span<const float> values) {
  CellNumbers numbers{0, {}};
  numbers.codes.reserve(values.size());
  for (const float value : values) numbers.codes.push_back(std::bit_cast<int32_t>(value));
  const bool isZero = std::all_of(numbers.codes.begin(), numbers.codes.end(), [](int32_t code) { return code == 0; });
  if (isZero) numbers.step = 1;
  return numbers;
}

}  // namespace

CellNumbers toNumbers(std::vector<int32_t> indices, float step, std::span<const float> values) {
  return indices.empty() ? rawNumbers(values) : CellNumbers{step, std::move(indices)};
}

CellNumbers toNumbers(std::vector<int32_t> indices, float step, std::span<const float> values,
                      std::span<const uint8_t> scales) {
  if (indices.empty() || scales.empty()) return toNumbers(std::move(indices), step, values);
  const size_t perCell = indices.size() / scales.size();
  const int lowest = *std::min_element(scales.begin(), scales.end());
  for (size_t i = 0; i < indices.size(); ++i) {
    const int64_t code = int64_t{indices[i]} * (int64_t{1} << (scales[i / perCell] - lowest));
    if (std::abs(code) > kMaxLatticeIndex) return rawNumbers(values);  // no exact float
    indices[i] = static_cast<int32_t>(code);
  }
  return {std::ldexp(step, lowest), std::move(indices)};
}

CellNumbers toColourNumbers(std::vector<int32_t> indices, float step, std::span<const float> values) {
  for (size_t i = 0; i < indices.size(); i += 3) {
    const std::array<int32_t, 3> separated = separateGreen(indices[i], indices[i + 1], indices[i + 2]);
    std::copy(separated.begin(), separated.end(), indices.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return toNumbers(std::move(indices), step, values);
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
