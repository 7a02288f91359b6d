// What repeated measurements say: a middle, and how far they scatter.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace froth {

struct Percentiles {
  double median = 0, p5 = 0, p95 = 0;
  double p999 = 0, worst = 0;  // 99.9th percentile and largest: what a player feels as a hitch
};

// Nearest rank; `values` not empty.
inline Percentiles percentilesOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
  };
  return {at(0.5), at(0.05), at(0.95), at(0.999), values.back()};
}

}  // namespace froth
