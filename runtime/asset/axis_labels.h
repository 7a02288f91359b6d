// The lobe axes of a chunk by number; those used again and again are the entries of a table.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "runtime/asset/cell_numbers.h"

namespace froth {

using AxisCode = std::array<int32_t, 3>;

struct AxisLabels {
  uint32_t componentBits = 32;  // of an axis written out: two's complement, or floats
  std::vector<AxisCode> table;  // empty: every lobe's axis is written out, and there are no labels
  // [lobes] < axisCount, the same for the same axis; < table.size(): its place in the table
  std::vector<uint32_t> labels;
  uint32_t axisCount = 0;  // different axes
};

// `axes` [3 * lobes]. Takes those axes into the table that make the chunk smaller.
AxisLabels labelAxes(const CellNumbers& axes);

}  // namespace froth
