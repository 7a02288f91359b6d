#include "foam/site_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <tbb/parallel_invoke.h>

namespace froth {
namespace {

// Powers and distances to boxes carry a few roundings of 2^-53 each; bounds are lowered by more than their
// sum.
constexpr double kSlack = 0x1p-48;

// Larger nodes are only split in space: regions of a scene are such nodes.
constexpr uint32_t kMaxSplitByRadius = 1 << 12;
constexpr uint32_t kParallelNode = 1 << 13;  // smaller ones are not worth a task of their own

}  // namespace

SiteTree::SiteTree(std::span<const glm::vec3> sites, std::span<const float> radii, std::vector<uint32_t> members)
    : sites_(sites), radii_(radii), order_(std::move(members)) {
  const auto leaves = static_cast<uint32_t>((order_.size() + kLeafSize - 1) / kLeafSize);
  depth_ = leaves > 1 ? static_cast<uint32_t>(std::bit_width(leaves - 1)) : 0;
  boxes_.resize(size_t{2} << depth_);
  build(0, 0);
}

// Bounds a node and splits it at its median along the axis in which it is longest.
void SiteTree::build(uint32_t depth, uint32_t k) {
  const Range range = rangeAt(depth, k);
  SiteBox& box = boxes_[(size_t{1} << depth) + k];
  float minRadius = INFINITY;
  for (uint32_t place = range.begin; place < range.end; ++place) {
    const uint32_t site = order_[place];
    box.low = glm::min(box.low, sites_[site]);
    box.high = glm::max(box.high, sites_[site]);
    box.ballLow = glm::min(box.ballLow, sites_[site] - radii_[site]);
    box.ballHigh = glm::max(box.ballHigh, sites_[site] + radii_[site]);
    box.maxRadius = std::max(box.maxRadius, radii_[site]);
    minRadius = std::min(minRadius, radii_[site]);
  }
  for (int axis = 0; axis < 3; ++axis) {  // the sums round, and a ball must not stick out
    box.ballLow[axis] = std::nextafter(box.ballLow[axis], -INFINITY);
    box.ballHigh[axis] = std::nextafter(box.ballHigh[axis], INFINITY);
  }
  if (depth == depth_) return;

  const glm::vec3 size = box.high - box.low;
  const bool isSplitByRadius =
      range.end - range.begin <= kMaxSplitByRadius && box.maxRadius - minRadius > std::max({size.x, size.y, size.z});
  const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
  const auto key = [&](uint32_t site) { return std::pair(isSplitByRadius ? radii_[site] : sites_[site][axis], site); };
  const auto begin = order_.begin();
  std::nth_element(begin + range.begin, begin + rangeAt(depth + 1, 2 * k).end, begin + range.end,
                   [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  if (range.end - range.begin >= kParallelNode) {
    tbb::parallel_invoke([&] { build(depth + 1, 2 * k); }, [&] { build(depth + 1, 2 * k + 1); });
  } else {
    build(depth + 1, 2 * k);
    build(depth + 1, 2 * k + 1);
  }
}

// `bound` is no more than every value in a node; a value below `enough` ends the search.
template <class Bound, class Value>
NearestSite SiteTree::findNearest(const Bound& bound, const Value& value, uint32_t known, double enough) const {
  NearestSite best;
  if (known != kNone) best = {known, value(known)};
  double limit = best.value;
  search(limit, bound, [&](uint32_t place) {
    const uint32_t site = order_[place];
    const double found = value(site);
    if (found < best.value || (found == best.value && best.site != known && site < best.site)) best = {site, found};
    limit = best.value < enough ? -INFINITY : best.value;
  });
  return best;
}

NearestSite SiteTree::findLeastPower(const glm::dvec3& x, uint32_t known) const {
  const auto bound = [&](const Node& node) {
    const glm::dvec3 gap = gapTo(node.box, x);
    const double squaredGap = glm::dot(gap, gap), weight = double{node.box.maxRadius} * node.box.maxRadius;
    return squaredGap - weight - kSlack * (squaredGap + weight);
  };
  return findNearest(
      bound, [&](uint32_t site) { return powerAt(x, sites_[site], radii_[site]); }, known, -INFINITY);
}

NearestSite SiteTree::findNearestBall(const glm::dvec3& x, uint32_t known) const {
  const auto bound = [&](const Node& node) {
    const double gap = glm::length(gapTo(node.box, x)), radius = node.box.maxRadius;
    return gap - radius - kSlack * (gap + radius);
  };
  const auto value = [&](uint32_t site) { return glm::length(glm::dvec3(sites_[site]) - x) - radii_[site]; };
  return findNearest(bound, value, known, 0);
}

}  // namespace froth
