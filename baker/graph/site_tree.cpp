#include "baker/graph/site_tree.h"

#include <algorithm>

#include <tbb/parallel_for.h>

namespace froth {
namespace {

// Powers and distances to boxes carry a few roundings of 2^-53 each; bounds are lowered by more than their
// sum.
constexpr double kSlack = 0x1p-48;

SiteBox unite(const SiteBox& a, const SiteBox& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high), std::max(a.maxRadius, b.maxRadius)};
}

}  // namespace

SiteTree::SiteTree(std::span<const glm::vec3> sites, std::span<const float> radii,
                   std::span<const uint32_t> order)
    : sites_(sites), radii_(radii), order_(order) {
  const uint32_t count = static_cast<uint32_t>(order.size());
  leafCount_ = std::bit_ceil((count + kLeafSize - 1) / kLeafSize);
  boxes_.resize(size_t{2} * leafCount_);
  tbb::parallel_for(uint32_t{0}, (count + kLeafSize - 1) / kLeafSize, [&](uint32_t leaf) {
    SiteBox& box = boxes_[leafCount_ + leaf];
    for (uint32_t k = leaf * kLeafSize; k < std::min((leaf + 1) * kLeafSize, count); ++k) {
      box = unite(box, {sites[order[k]], sites[order[k]], radii[order[k]]});
    }
  });
  for (uint32_t node = leafCount_ - 1; node >= 1; --node)
    boxes_[node] = unite(boxes_[size_t{2} * node], boxes_[size_t{2} * node + 1]);
}

LeastPower SiteTree::findLeastPower(const glm::dvec3& x) const {
  LeastPower best;
  double limit = INFINITY;
  const auto bound = [&](const Node& node) {
    const glm::dvec3 gap = gapTo(node.box, x);
    const double squaredGap = glm::dot(gap, gap), weight = double{node.box.maxRadius} * node.box.maxRadius;
    return squaredGap - weight - kSlack * (squaredGap + weight);
  };
  search(limit, bound, [&](uint32_t place) {
    const uint32_t site = order_[place];
    const double power = powerAt(x, sites_[site], radii_[site]);
    if (power < best.power || (power == best.power && site < best.site)) best = {site, power};
    limit = best.power;
  });
  return best;
}

}  // namespace froth
