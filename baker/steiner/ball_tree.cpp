#include "baker/steiner/ball_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>

#include "foam/morton_order.h"
#include "shaders/foam/cell.h"

namespace froth {
namespace {

constexpr size_t kLeafBalls = 8;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

double distanceToBox(const glm::dvec3& point, const glm::dvec3& low, const glm::dvec3& high) {
  return glm::length(glm::max(glm::max(low - point, point - high), glm::dvec3(0)));
}

}  // namespace

BallTree::BallTree(std::span<const glm::vec3> sites, std::span<const float> radii)
    : order_(mortonOrder(sites)), place_(sites.size()) {
  balls_.resize(sites.size());
  const size_t leaves = std::bit_ceil(std::max<size_t>(1, (sites.size() + kLeafBalls - 1) / kLeafBalls));
  firstLeaf_ = leaves - 1;
  nodes_.assign(firstLeaf_ + leaves, {glm::vec3(kInfinity), glm::vec3(-kInfinity), 0, kInfinity});
  tbb::parallel_for(size_t{0}, leaves, [&](size_t leaf) {
    Node& node = nodes_[firstLeaf_ + leaf];
    for (size_t k = leaf * kLeafBalls; k < std::min((leaf + 1) * kLeafBalls, sites.size()); ++k) {
      const Ball ball = balls_[k] = {sites[order_[k]], radii[order_[k]]};
      place_[order_[k]] = static_cast<uint32_t>(k);
      // nextafter: the sums round, and a bound must never be too tight.
      node.low = glm::min(node.low, ball.site - ball.radius);
      node.high = glm::max(node.high, ball.site + ball.radius);
      node.largest = std::max(node.largest, ball.radius);
      node.smallest = std::min(node.smallest, ball.radius);
    }
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis] = std::nextafter(node.low[axis], -kInfinity);
      node.high[axis] = std::nextafter(node.high[axis], kInfinity);
    }
  });
  for (size_t k = firstLeaf_; k-- > 0;) {
    const Node &a = nodes_[2 * k + 1], &b = nodes_[2 * k + 2];
    nodes_[k] = {glm::min(a.low, b.low), glm::max(a.high, b.high), std::max(a.largest, b.largest),
                 std::min(a.smallest, b.smallest)};
  }
}

// Depth first, the nearer child first, until a value below `enough` is found. `bound` is below every value in
// a node.
template <class Bound, class Value>
BallTree::Nearest BallTree::search(const Bound& bound, const Value& value, uint32_t known,
                                   double enough) const {
  constexpr size_t kStackSize = 64;  // one per level of a tree over 2^32 balls, and some
  std::pair<double, size_t> stack[kStackSize];
  size_t depth = 0;
  stack[depth++] = {bound(nodes_[0]), 0};
  Nearest nearest;
  if (known != kNone) nearest = {known, value(balls_[place_[known]])};
  while (depth > 0) {
    const auto [least, k] = stack[--depth];
    if (!(least < nearest.value)) continue;
    if (k < firstLeaf_) {
      std::pair<double, size_t> first{bound(nodes_[2 * k + 1]), 2 * k + 1},
          second{bound(nodes_[2 * k + 2]), 2 * k + 2};
      if (second.first < first.first) std::swap(first, second);
      stack[depth++] = second;
      stack[depth++] = first;
      continue;
    }
    const size_t begin = (k - firstLeaf_) * kLeafBalls, end = std::min(begin + kLeafBalls, balls_.size());
    for (size_t i = begin; i < end; ++i) {
      const double found = value(balls_[i]);
      if (found < nearest.value) nearest = {order_[i], found};
    }
    if (nearest.value < enough) break;
  }
  return nearest;
}

BallTree::Nearest BallTree::nearestSurface(const glm::dvec3& point, uint32_t known) const {
  const auto bound = [&](const Node& node) {
    const double distance = distanceToBox(point, node.low, node.high);
    return distance > 0 ? distance : -double{node.largest};
  };
  const auto value = [&](const Ball& ball) {
    return glm::length(glm::dvec3(ball.site) - point) - ball.radius;
  };
  return search(bound, value, known, 0);
}

BallTree::Nearest BallTree::nearestPower(const glm::dvec3& point, uint32_t known) const {
  const auto bound = [&](const Node& node) {
    const double distance = distanceToBox(point, node.low, node.high);
    return distance > 0 ? distance * (distance + 2.0 * node.smallest) : -double{node.largest} * node.largest;
  };
  const auto value = [&](const Ball& ball) {
    return foam::powerOfOrigin(glm::dvec3(ball.site) - point, double{ball.radius});
  };
  return search(bound, value, known, -std::numeric_limits<double>::infinity());
}

}  // namespace froth
