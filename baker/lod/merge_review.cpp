#include "baker/lod/merge_review.h"

#include <numeric>

#include "baker/lod/level_front.h"

namespace froth {
namespace {

constexpr double kOutlier = 6;  // of the mean error

}  // namespace

std::vector<uint32_t> findOutliers(std::span<const double> errors) {
  const double sum = std::accumulate(errors.begin(), errors.end(), 0.0);
  std::vector<uint32_t> outliers;
  for (uint32_t cell = 0; cell < errors.size(); ++cell) {
    if (errors[cell] * static_cast<double>(errors.size()) > kOutlier * sum) outliers.push_back(cell);
  }
  return outliers;
}

Result<LevelErrors::OwnerErrors> drawPlans(const LevelSource& source, std::span<const LevelChunk> chunks,
                                           std::span<const MergePlan* const> plans, const LevelErrors& errors,
                                           const LevelFit& fit, const Progress& progress) {
  LevelFront front = gatherPlannedFront(source, chunks, plans);
  std::vector<uint8_t> isFree;
  uint32_t merges = 0;
  for (const uint32_t owner : front.owners) {
    isFree.push_back(owner != kNoOwner ? 1 : 0);
    merges += isFree.back();
  }
  if (fit.isFitting()) {
    if (Status status = fit.fit(front.foam, isFree, kViewsOfReview, progress); !status) return status.error();
  }
  return errors.sumByOwner(front.foam, front.owners, merges, progress);
}

}  // namespace froth
