#include "baker/lod/sights.h"

#include <map>
#include <numeric>

namespace froth {

Visibility beginSights(const Visibility& input, uint32_t detailCount) {
  Visibility merged;
  merged.eyes = input.eyes;
  merged.pixels = input.pixels;
  merged.offsets = {0};
  merged.detailsPerRow = detailCount;
  return merged;
}

void appendSights(const Visibility& input, uint32_t inputCount, std::span<const uint32_t> members, Visibility& merged) {
  const uint32_t K = merged.detailsPerRow;
  std::map<uint16_t, float> sums;  // by view
  const auto addRows = [&](const Visibility& rows, uint64_t first, uint64_t count, float share) {
    for (uint64_t i = rows.offsets[first]; i < rows.offsets[first + count]; ++i) {
      sums[rows.views[i]] += share * rows.weights[i];
    }
  };
  for (const uint32_t member : members) {
    if (member < inputCount) {
      addRows(input, uint64_t{member} * K, K, 1.0f / static_cast<float>(K));
    } else {
      addRows(merged, member - inputCount, 1, 1);
    }
  }
  for (const auto& [view, weight] : sums) {
    merged.views.push_back(view);
    merged.weights.push_back(weight);
  }
  merged.offsets.push_back(merged.views.size());
}

void normaliseSights(std::span<const LevelReport> reports, Visibility& merged) {
  uint64_t row = 0;
  for (const LevelReport& report : reports) {
    const uint64_t first = merged.offsets[row], end = merged.offsets[row + report.merges];
    const std::span<float> weights = std::span(merged.weights).subspan(first, end - first);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (float& weight : weights) weight = static_cast<float>(weight * static_cast<double>(report.merges) / sum);
    row += report.merges;
  }
}

}  // namespace froth
