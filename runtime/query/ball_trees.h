// Trees over the balls of cells: which ball a ray enters next, and which cell a point has the least power to, in time
// that does not grow with the neighbours of the cells in open space.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include <glm/glm.hpp>

#include "runtime/query/box_tree.h"

namespace froth {

// Of live cells and of the others: only live ones stop rays.
struct BallTrees {
  BoxTree live, others;

  uint64_t bytes() const { return live.bytes() + others.bytes(); }
};

// Cells in a row that are one item of a chunk's trees: 7 and an eighth more bytes per cell.
inline constexpr uint32_t kBallsPerBox = 4;

// siteRadius: [cellCount or more], the live ones first.
BallTrees makeBallTrees(std::span<const glm::vec4> siteRadius, uint32_t cellCount, uint32_t liveCount);

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

// The same for the power of a point.
class PowerBounds {
 public:
  PowerBounds(const glm::dvec3& point, const BallBox& bounds);

  void measure(const BoxTree::Node& node, float (&bounds)[BoxTree::kWidth]) const;
  static float limitOf(double power);

 private:
  float point_[3];
  float slack_;
};

}  // namespace froth
