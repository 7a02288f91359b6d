// A bounding volume hierarchy over sites with radii, for searches by power, by overlap and along rays.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

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

// Implicit binary tree over the sites in a given order, best a space-filling curve: node k has children 2k
// and 2k + 1; leaf l is node leafCount + l and holds places [l * kLeafSize, (l + 1) * kLeafSize) of the
// order. Refers to the arrays it was made from. Searches may run at the same time.
class SiteTree {
 public:
  SiteTree(std::span<const glm::vec3> sites, std::span<const float> radii, std::span<const uint32_t> order);

  // A node on a search's way: the sites at places [begin, end) of the order lie in `box`.
  struct Node {
    const SiteBox& box;
    uint32_t begin, end;
  };

  // Visits the place of every site whose nodes all have bound(node) <= limit, the children of smaller bound
  // first; `visit` may lower the limit meanwhile.
  template <class Bound, class Visit>
  void search(const double& limit, const Bound& bound, const Visit& visit) const;

  // The least power at x, and the lowest of the sites that attain it in double.
  LeastPower findLeastPower(const glm::dvec3& x) const;

 private:
  static constexpr uint32_t kLeafSize = 8;

  std::span<const glm::vec3> sites_;
  std::span<const float> radii_;
  std::span<const uint32_t> order_;
  uint32_t leafCount_ = 1;
  std::vector<SiteBox> boxes_;
};

template <class Bound, class Visit>
void SiteTree::search(const double& limit, const Bound& bound, const Visit& visit) const {
  struct Open {
    uint32_t node, leaf, leaves;  // leaves [leaf, leaf + leaves) lie below the node
    double bound;
  };
  const uint32_t count = static_cast<uint32_t>(order_.size());
  const auto open = [&](uint32_t node, uint32_t leaf, uint32_t leaves) -> Open {
    const uint32_t begin = leaf * kLeafSize;
    if (begin >= count) return {node, leaf, leaves, INFINITY};
    return {node, leaf, leaves,
            bound(Node{boxes_[node], begin, std::min(begin + leaves * kLeafSize, count)})};
  };
  std::array<Open, 64> stack;  // a depth-first search of a binary tree keeps one node per level, plus one
  uint32_t depth = 0;
  stack[depth++] = open(1, 0, leafCount_);
  while (depth > 0) {
    const Open top = stack[--depth];
    if (!(top.bound <= limit) || top.leaf * kLeafSize >= count) continue;
    if (top.leaves == 1) {
      const uint32_t begin = top.leaf * kLeafSize, end = std::min(begin + kLeafSize, count);
      for (uint32_t k = begin; k < end; ++k) visit(k);
      continue;
    }
    const uint32_t half = top.leaves / 2;
    Open near = open(2 * top.node, top.leaf, half), far = open(2 * top.node + 1, top.leaf + half, half);
    if (far.bound < near.bound) std::swap(near, far);
    if (far.bound <= limit) stack[depth++] = far;
    if (near.bound <= limit) stack[depth++] = near;
  }
}

}  // namespace froth
