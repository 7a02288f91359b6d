// In which views merged cells show, and how much: what the cells that they stand for show. Internal to baker/lod.
#pragma once

#include <cstdint>
#include <span>

#include "baker/appearance/visibility.h"
#include "baker/lod/level_report.h"

namespace froth {

// Without rows. A merged cell has one, for its detail sites show alike.
Visibility beginSights(const Visibility& input, uint32_t detailCount);

// A further row: what each detail site of the members shows in the mean, summed over members. `members`: cells of the
// input foam, and from `inputCount` on rows of `merged`.
void appendSights(const Visibility& input, uint32_t inputCount, std::span<const uint32_t> members, Visibility& merged);

// Rows of each level get a weight of 1 in the mean. They are those of the merges of the reports, level by level.
void normaliseSights(std::span<const LevelReport> reports, Visibility& merged);

}  // namespace froth
