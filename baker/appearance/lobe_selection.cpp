#include "baker/appearance/lobe_selection.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace froth {

uint32_t LobeSelection::findMostHeard() const {
  const size_t count = basis_.axes().size();
  std::vector<uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  std::vector<double> shares(count), heard(count);
  for (size_t i = 0; i < seen_.size(); ++i) {
    basis_.sharesAlong(i, all, shares.data());
    for (size_t a = 0; a < count; ++a) heard[a] += seen_.weights[i] * shares[a];
  }
  return static_cast<uint32_t>(std::max_element(heard.begin(), heard.end()) - heard.begin());
}

bool LobeSelection::grow() {
  const auto count = static_cast<uint32_t>(basis_.axes().size());
  if (chosen_.size() == count) return false;
  if (chosen_.empty()) {
    chosen_.push_back(findMostHeard());
    leastError_ = LobeEquations(seen_, basis_, chosen_, base_).leastError();
    return true;
  }
  uint32_t best = 0;  // plus one
  leastError_ = std::numeric_limits<double>::infinity();
  std::vector<uint32_t> tried = chosen_;
  tried.push_back(0);
  for (uint32_t a = 0; a < count; ++a) {
    if (std::find(chosen_.begin(), chosen_.end(), a) != chosen_.end()) continue;
    tried.back() = a;
    const double error = LobeEquations(seen_, basis_, tried, base_).leastError();
    if (best == 0 || error < leastError_) {
      leastError_ = error;
      best = a + 1;
    }
  }
  chosen_.push_back(best - 1);
  return true;
}

}  // namespace froth
