// A bounding volume hierarchy over sites with radii, for searches by power, by distance, by overlap and along rays. It
// only saves time:
// what is found never depends on it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "shaders/foam/cell.h"

namespace froth {

// What is known of the sites in a box.
struct SiteBox {
  glm::vec3 low{INFINITY}, high{-INFINITY};          // of the sites; exact in float
  glm::vec3 ballLow{INFINITY}, ballHigh{-INFINITY};  // of their balls, rounded outwards
  float maxRadius = 0;
};

// Vector from x to the nearest place of a box; zero inside.
inline glm::dvec3 gapTo(const SiteBox& box, const glm::dvec3& x) {
  return glm::max(glm::max(glm::dvec3(box.low) - x, x - glm::dvec3(box.high)), glm::dvec3(0));
}

// The site with the least value of something at some place.
struct NearestSite {
  uint32_t site = 0;
  double value = INFINITY;
};

// |x - p|^2 - r^2 [scene units squared], true to some roundings of 2^-53 of |x - p|^2 + r^2.
inline double powerAt(const glm::dvec3& x, const glm::vec3& site, float radius) {
  return foam::powerOfOrigin(glm::dvec3(site) - x, double{radius});
}

// A balanced kd-tree over some of the sites; small nodes are split by radius where that differs more than the
// places do, so that a giant does not blow up the bounds of the small balls around it. The tree puts its
// sites in order: every node is a range of places in it. Refers to the arrays it was made from; searches may
// run at the same time.
class SiteTree {
 public:
  SiteTree(std::span<const glm::vec3> sites, std::span<const float> radii, std::vector<uint32_t> members);

  // Of all sites.
  const SiteBox& bounds() const { return boxes_[1]; }

  // The site at each place.
  const std::vector<uint32_t>& order() const { return order_; }

  struct Range {
    uint32_t begin, end;
  };
  // The places of node k of the 2^depth of that depth. The last depth has at most kLeafSize sites per node.
  Range rangeAt(uint32_t depth, uint32_t k) const {
    return {static_cast<uint32_t>(uint64_t{order_.size()} * k >> depth),
            static_cast<uint32_t>(uint64_t{order_.size()} * (k + 1) >> depth)};
  }
  uint32_t depth() const { return depth_; }

  // A node on a search's way: the sites at places [begin, end) lie in `box`.
  struct Node {
    const SiteBox& box;
    uint32_t begin, end;
  };

  // Visits the place of every site whose nodes all have bound(node) <= limit, the children of smaller bound
  // first; `visit` may lower the limit meanwhile.
  template <class Bound, class Visit>
  void search(const double& limit, const Bound& bound, const Visit& visit) const;

  // Calls visit(site) for every site whose ball a ray may meet at t >= 0, by the rounding of float or of double, and
  // for some others, in no useful order; the direction has unit length, up to the rounding of float.
  template <class Visit>
  void searchRay(const glm::dvec3& origin, const glm::dvec3& direction, const Visit& visit) const;

  // Those whose ball the ray meets, in double.
  template <class Visit>
  void searchBallsOn(const glm::dvec3& origin, const glm::dvec3& direction, const Visit& visit) const;

  static constexpr uint32_t kNone = UINT32_MAX;

  // The site of least power at x: whose cell holds x. Of sites that attain it in double the lowest, but rather `known`,
  // a site that is known to be near and saves most of the search. No site at all: the value is infinite.
  NearestSite findLeastPower(const glm::dvec3& x, uint32_t known = kNone) const;

  // The ball nearest to x, the least |x - p| - r; equals as above. Inside of some ball the value is negative, and the
  // site one of those whose balls hold x.
  NearestSite findNearestBall(const glm::dvec3& x, uint32_t known = kNone) const;

 private:
  static constexpr uint32_t kLeafSize = 8;

  void build(uint32_t depth, uint32_t k);
  template <class Bound, class Value>
  NearestSite findNearest(const Bound& bound, const Value& value, uint32_t known, double enough) const;

  std::span<const glm::vec3> sites_;
  std::span<const float> radii_;
  std::vector<uint32_t> order_;
  uint32_t depth_;
  std::vector<SiteBox> boxes_;  // node k of depth d is 2^d + k
};

template <class Bound, class Visit>
void SiteTree::search(const double& limit, const Bound& bound, const Visit& visit) const {
  struct Open {
    uint32_t depth, k;
    double bound;
  };
  const auto open = [&](uint32_t depth, uint32_t k) -> Open {
    const Range range = rangeAt(depth, k);
    return {depth, k, bound(Node{boxes_[(size_t{1} << depth) + k], range.begin, range.end})};
  };
  if (order_.empty()) return;
  std::array<Open, 64> stack;  // a depth-first search of a binary tree keeps one node per level, plus one
  uint32_t count = 0;
  stack[count++] = open(0, 0);
  while (count > 0) {
    const Open top = stack[--count];
    if (!(top.bound <= limit)) continue;
    if (top.depth == depth_) {
      const Range range = rangeAt(top.depth, top.k);
      for (uint32_t place = range.begin; place < range.end; ++place) visit(place);
      continue;
    }
    Open near = open(top.depth + 1, 2 * top.k), far = open(top.depth + 1, 2 * top.k + 1);
    if (far.bound < near.bound) std::swap(near, far);
    if (far.bound <= limit) stack[count++] = far;
    if (near.bound <= limit) stack[count++] = near;
  }
}

template <class Visit>
void SiteTree::searchRay(const glm::dvec3& origin, const glm::dvec3& direction, const Visit& visit) const {
  // The test of a ball itself may run in float, where one at distance D seems larger by some 1e-7 D.
  constexpr double kRelativePadding = 1e-5;
  const glm::dvec3 unit = glm::normalize(direction);  // far away a rounding of its length is more than a ball's radius
  // A direction of 0 gets a huge inverse instead of an infinite one: 0 * infinity would be NaN.
  constexpr double kTiny = 1e-200;
  glm::dvec3 inverse;
  for (int axis = 0; axis < 3; ++axis) {
    inverse[axis] = 1 / (std::abs(direction[axis]) > kTiny ? direction[axis] : kTiny);
  }
  // 0: the ray meets the box of the balls; 1: it does not.
  const auto bound = [&](const Node& node) {
    const glm::dvec3 low = glm::dvec3(node.box.ballLow) - origin, high = glm::dvec3(node.box.ballHigh) - origin;
    const glm::dvec3 farthest = glm::max(glm::abs(low), glm::abs(high));
    const double padding = kRelativePadding * glm::max(farthest.x, glm::max(farthest.y, farthest.z));
    double tNear = 0, tFar = HUGE_VAL;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (low[axis] - padding) * inverse[axis], b = (high[axis] + padding) * inverse[axis];
      tNear = std::max(tNear, std::min(a, b));
      tFar = std::min(tFar, std::max(a, b));
    }
    return tNear <= tFar ? 0.0 : 1.0;
  };
  search(0.0, bound, [&](uint32_t place) {
    const uint32_t site = order_[place];
    const glm::dvec3 centre = glm::dvec3(sites_[site]) - origin;
    const double along = glm::dot(centre, unit), squared = glm::dot(centre, centre);
    const double reach = radii_[site] * (1 + kRelativePadding) + kRelativePadding * std::sqrt(squared);
    if (along >= -reach && squared - along * along <= reach * reach) visit(site);
  });
}

template <class Visit>
void SiteTree::searchBallsOn(const glm::dvec3& origin, const glm::dvec3& direction, const Visit& visit) const {
  searchRay(origin, direction, [&](uint32_t site) {
    double tNear, tFar;
    const glm::dvec3 centre = glm::dvec3(sites_[site]) - origin;
    if (foam::intersectBall(centre, double{radii_[site]}, direction, tNear, tFar)) visit(site);
  });
}

}  // namespace froth
