// A bounding volume hierarchy over the balls of a foam. It only saves time: which cells an image shows, and
// in which order, never depends on it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

class BallHierarchy {
 public:
  // Over the balls of `cells`, indices into sites and radii.
  BallHierarchy(std::span<const glm::vec3> sites, std::span<const float> radii, std::vector<uint32_t> cells);

  // Calls visit(cell) for every cell whose ball the ray may meet at t >= 0, and for some others, in no useful
  // order. `direction` has unit length.
  template <class Visitor>
  void visitAlongRay(const glm::dvec3& origin, const glm::dvec3& direction, Visitor&& visit) const;

 private:
  struct Box {
    glm::dvec3 low, high;
  };
  struct Node {
    Box box;
    uint32_t first =
        0;  // inner node: index of its second child (the first one follows it); leaf: index into cells_
    uint32_t count = 0;  // leaf: number of cells; inner node: 0
  };
  static constexpr uint32_t kLeafSize = 2;
  static constexpr uint32_t kMaxDepth = 64;  // halving 2^32 cells ends after 32 levels

  uint32_t build(uint32_t begin, uint32_t end, std::span<const glm::vec3> sites,
                 std::span<const float> radii);
  static bool mayMeet(const Box& box, const glm::dvec3& origin, const glm::dvec3& inverseDirection);

  std::vector<Node> nodes_;      // the first one is the root
  std::vector<uint32_t> cells_;  // each node covers a range
};

inline bool BallHierarchy::mayMeet(const Box& box, const glm::dvec3& origin,
                                   const glm::dvec3& inverseDirection) {
  // The test of the ball itself may run in float, where a ball at distance D seems larger by some 1e-7 D.
  constexpr double kRelativePadding = 1e-5;
  const glm::dvec3 low = box.low - origin, high = box.high - origin;
  const glm::dvec3 farthest = glm::max(glm::abs(low), glm::abs(high));
  const double padding = kRelativePadding * glm::max(farthest.x, glm::max(farthest.y, farthest.z));
  double tNear = 0, tFar = HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low[axis] - padding) * inverseDirection[axis],
                 b = (high[axis] + padding) * inverseDirection[axis];
    tNear = std::max(tNear, std::min(a, b));
    tFar = std::min(tFar, std::max(a, b));
  }
  return tNear <= tFar;
}

template <class Visitor>
void BallHierarchy::visitAlongRay(const glm::dvec3& origin, const glm::dvec3& direction,
                                  Visitor&& visit) const {
  if (nodes_.empty()) return;
  // A direction of 0 gets a huge inverse instead of an infinite one: 0 * infinity would be NaN.
  constexpr double kTiny = 1e-200;
  glm::dvec3 inverse;
  for (int axis = 0; axis < 3; ++axis)
    inverse[axis] = 1 / (std::abs(direction[axis]) > kTiny ? direction[axis] : kTiny);

  uint32_t stack[kMaxDepth];
  uint32_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const uint32_t index = stack[--depth];
    const Node& node = nodes_[index];
    if (!mayMeet(node.box, origin, inverse)) continue;
    if (node.count > 0) {
      for (uint32_t i = 0; i < node.count; ++i) visit(cells_[node.first + i]);
    } else {
      stack[depth++] = node.first;
      stack[depth++] = index + 1;
    }
  }
}

}  // namespace froth
