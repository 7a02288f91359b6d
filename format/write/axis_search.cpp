#include "format/write/axis_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "format/lattice.h"

namespace froth {
namespace {

// The steps from `entry` to `axis`, if they give it back exactly.
std::optional<std::array<int32_t, 3>> stepsBetween(glm::vec3 entry, glm::vec3 axis, float step) {
  std::array<int32_t, 3> steps{};
  if (step == 0) return entry == axis ? std::optional(steps) : std::nullopt;
  for (int i = 0; i < 3; ++i) {
    const double index = std::nearbyint((double{axis[i]} - double{entry[i]}) / step);
    if (!(std::abs(index) <= kMaxLatticeIndex)) return {};
    steps[static_cast<size_t>(i)] = static_cast<int32_t>(index);
    if (entry[i] + step * static_cast<float>(index) != axis[i]) return {};
  }
  return steps;
}

}  // namespace

AxisSearch::AxisSearch(std::span<const glm::vec3> codebook, float step) : step_(step) {
  for (uint32_t label = 0; label < codebook.size(); ++label) entries_.push_back({codebook[label], label});
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return std::tie(a.axis.x, a.label) < std::tie(b.axis.x, b.label); });
}

// From the axis' x outwards in both directions, until x alone is farther away than the best entry.
std::optional<AxisCode> AxisSearch::find(glm::vec3 axis) const {
  std::optional<AxisCode> best;
  double bestDistance = std::numeric_limits<double>::infinity();
  const auto visit = [&](const Entry& entry) {
    const glm::dvec3 difference = glm::dvec3(axis) - glm::dvec3(entry.axis);
    if (difference.x * difference.x > bestDistance) return false;
    const double distance = glm::dot(difference, difference);
    if (distance > bestDistance || (best && distance == bestDistance && entry.label > best->label)) return true;
    if (const auto steps = stepsBetween(entry.axis, axis, step_)) {
      best = {entry.label, *steps};
      bestDistance = distance;
    }
    return true;
  };
  const auto middle = std::lower_bound(entries_.begin(), entries_.end(), axis.x,
                                       [](const Entry& entry, float x) { return entry.axis.x < x; });
  for (auto right = middle; right != entries_.end() && visit(*right); ++right) {
  }
  for (auto left = middle; left != entries_.begin() && visit(*(left - 1)); --left) {
  }
  return best;
}

}  // namespace froth
