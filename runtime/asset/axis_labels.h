// Lobe axes that a chunk uses again and again, as labels into a table.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "runtime/asset/cell_numbers.h"

namespace froth {

using AxisCode = std::array<int32_t, 3>;

struct AxisLabels {
  static constexpr uint32_t kNone = UINT32_MAX;

  uint32_t componentBits = 32;   // of an axis written out: two's complement, or floats
  std::vector<AxisCode> table;   // empty: every lobe's axis is written out
  std::vector<uint32_t> labels;  // [lobes] kNone: not in the table
};

// `axes` [3 * lobes]. Takes those axes into the table that make the chunk smaller.
AxisLabels labelAxes(const CellNumbers& axes);

}  // namespace froth
