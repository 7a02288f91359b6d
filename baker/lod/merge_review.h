// Which merges of a level get its pictures wrong. Internal to baker/lod.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace froth {

// How often the merges of a level are drawn, and those that stand out made otherwise.
inline constexpr int kReviews = 3;

// Merged cells whose error stands out from the mean, ascending. A few cells that cover what lies beside them, or lose
// a texture, have most of a level's error, and no cost of a pair told them (docs/notes/levels.md "Merges that are
// drawn").
// `errors`: [merged cells] squared.
std::vector<uint32_t> findOutliers(std::span<const double> errors);

}  // namespace froth
