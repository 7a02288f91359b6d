#include "baker/lod/merge_review.h"

#include <numeric>

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

}  // namespace froth
