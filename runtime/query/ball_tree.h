// A tree over the balls of live cells: which of them a ray enters next, in time that does not grow with the neighbours
// of the cells in open space.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include <glm/glm.hpp>

#include "runtime/query/box_tree.h"

namespace froth {

// Cells in a row that are one item of a chunk's tree: 7 and an eighth more bytes per cell.
inline constexpr uint32_t kBallsPerBox = 4;

// Of balls (centre, radius) that come along a curve.
BoxTree makeBallTree(std::span<const glm::vec4> balls);

// What a search for the ball that a ray enters first asks of boxes, in the frame of a tree. Boxes are met in float and
// thickened by more than that rounds: none is missed.
class RayBounds {
 public:
  // t from `from` on.
  RayBounds(const glm::dvec3& origin, const glm::dvec3& direction, double from, const BallBox& bounds);

  void measure(const BoxTree::Node& node, float (&bounds)[BoxTree::kWidth]) const;
  // A limit that no box of an earlier ball exceeds.
  static float limitOf(double t);

 private:
  float nearOrigin_[3], farOrigin_[3], inverse_[3];
  bool isForward_[3];
  float from_;
};

}  // namespace froth
