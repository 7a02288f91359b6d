// A bounding volume hierarchy over sites with radii, for searches by power, by overlap and along rays.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "shaders/foam/cell.h"

namespace froth {

// What is known of the sites in a box; exact in float.
struct SiteBox {
  glm::vec3 low{INFINITY}, high{-INFINITY};
  float maxRadius = 0;
};

// Vector from x to the nearest place of a box; zero inside.
inline glm::dvec3 gapTo(const SiteBox& box, const glm::dvec3& x) {
  return glm::max(glm::max(glm::dvec3(box.low) - x, x - glm::dvec3(box.high)), glm::dvec3(0));
}

// The site of least power at some place.
struct LeastPower {
  uint32_t site = 0;
  double power = INFINITY;  // |x - p|^2 - r^2 [scene units squared]
};

// |x - p|^2 - r^2, from the difference of places: true to some roundings of 2^-53 of |x - p|^2 + r^2.
inline double powerAt(const glm::dvec3& x, const glm::vec3& site, float radius) {
  const glm::dvec3 difference = x - glm::dvec3(site);
  return glm::dot(difference, difference) - double{radius} * radius;
}

// A balanced kd-tree over some of the sites; small nodes are split by radius where that differs more than the
// places do, so that a giant does not blow up the bounds of the small balls around it. The tree puts its
// sites in order: every node is a range of places in it. Refers to the arrays it was made from; searches may
// run at the same time.
class SiteTree {
 public:
  SiteTree(std::span<const glm::vec3> sites, std::span<const float> radii, std::vector<uint32_t> members);

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

  // Calls visit(site) for every site whose ball a ray meets; the direction has unit length.
  template <class Visit>
  void searchRay(const glm::dvec3& origin, const glm::dvec3& direction, const Visit& visit) const;

  // The least power at x, and the lowest of the sites that attain it in double.
  LeastPower findLeastPower(const glm::dvec3& x) const;

 private:
  static constexpr uint32_t kLeafSize = 8;

  void build(uint32_t depth, uint32_t k);

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
  // Distance of the ray's line from the ball around the box, less all radii: rounding may let a ball pass
  // that the ray merely touches.
  const auto bound = [&](const Node& node) {
    const glm::dvec3 low(node.box.low), high(node.box.high);
    const glm::dvec3 centre = 0.5 * (low + high) - origin;
    const double reach = 0.5 * glm::length(high - low) + node.box.maxRadius;
    const double along = std::max(glm::dot(centre, direction), 0.0);
    return glm::length(centre - along * direction) - reach;
  };
  search(0.0, bound, [&](uint32_t place) {
    const uint32_t site = order_[place];
    double tNear, tFar;
    const glm::dvec3 centre = glm::dvec3(sites_[site]) - origin;
    if (foam::intersectBall(centre, double{radii_[site]}, direction, tNear, tFar)) visit(site);
  });
}

}  // namespace froth
