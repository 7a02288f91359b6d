// Nearest balls of a point, by distance or by power, in double: a bounding volume hierarchy over the Morton
// order.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

class BallTree {
 public:
  static constexpr uint32_t kNone = 0xffffffff;
  struct Nearest {
    uint32_t ball = kNone;  // equal values: whichever comes first along the Morton curve
    double value = std::numeric_limits<double>::infinity();
  };

  // Copies what it needs. Finite sites and radii > 0.
  BallTree(std::span<const glm::vec3> sites, std::span<const float> radii);

  // Both take a ball that is known to be near, if the caller has one: it saves most of the search, and is the
  // answer when no other's value is smaller.

  // The ball with the least |point - p| - r: how far the point lies from all balls. Inside some ball the
  // value is negative, and the ball one of those that hold the point.
  Nearest nearestSurface(const glm::dvec3& point, uint32_t known = kNone) const;

  // The cell of the power diagram that holds the point: least |point - p|^2 - r^2.
  Nearest nearestPower(const glm::dvec3& point, uint32_t known = kNone) const;

  glm::dvec3 low() const { return nodes_[0].low; }  // bounding box of all balls
  glm::dvec3 high() const { return nodes_[0].high; }

 private:
  struct Ball {
    glm::vec3 site;
    float radius;
  };
  struct Node {
    glm::vec3 low, high;              // holds the balls, rounded outwards
    float largest = 0, smallest = 0;  // radii
  };

  template <class Bound, class Value>
  Nearest search(const Bound& bound, const Value& value, uint32_t known, double enough) const;

  // A complete binary tree: children of node k are 2k + 1 and 2k + 2, leaves cover kLeafBalls places each.
  std::vector<Node> nodes_;
  size_t firstLeaf_ = 0;
  std::vector<Ball> balls_;      // along the Morton curve
  std::vector<uint32_t> order_;  // their indices
  std::vector<uint32_t> place_;  // and where each index is
};

}  // namespace froth
