// Which merges of a level get its pictures wrong. Internal to baker/lod.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/lod/level_chunk.h"
#include "baker/lod/level_errors.h"
#include "baker/lod/level_fit.h"
#include "baker/lod/level_source.h"
#include "baker/lod/merge_plan.h"
#include "base/progress.h"
#include "base/result.h"

namespace froth {

// How often, at most, the merges of a level are drawn, and those that stand out made otherwise.
inline constexpr uint64_t kReviews = 3;
// What the level keeps of its error by a review that stays, at most: one that gains less is of the views that it looked
// through, and others lose.
inline constexpr double kKeptByReview = 0.9;
// Through how many views a planned level is fitted before it is drawn: an eighth of the fit that follows.
inline constexpr size_t kViewsOfReview = 48;

// Merged cells whose error stands out from the mean, ascending. A few cells that cover what lies beside them, or lose
// a texture, have most of a level's error, and no cost of a pair told them (docs/notes/levels.md "Merges that are
// drawn").
// `errors`: [merged cells] squared.
std::vector<uint32_t> findOutliers(std::span<const double> errors);

// The errors of pictures of a level as its plans make it; owners are merges, numbered through the plans. It is fitted
// somewhat before, since what a fit mends is no reason to stay apart. Fails with kCancelled.
Result<LevelErrors::OwnerErrors> drawPlans(const LevelSource& source, std::span<const LevelChunk> chunks,
                                           std::span<const MergePlan* const> plans, const LevelErrors& errors,
                                           const LevelFit& fit, const Progress& progress);

}  // namespace froth
