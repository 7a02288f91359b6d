// Puts cells of one foam behind those of another.
#pragma once

#include <cstdint>
#include <span>

#include "foam/foam.h"

namespace froth {

// Appends the listed cells of `from`. Both have the same detailCount, unless `to` has no cells: it then gets all
// counts. Where one of them has base colours or lobes of any number, the result has.
void appendCells(const Foam& from, std::span<const uint32_t> cells, Foam& to);

}  // namespace froth
