// The cells along a ray without any triangulation. Less the square of the distance, the power of a cell along
// a ray is a straight line, and the cells that the ray crosses are the lower envelope of all lines: a new
// cell cuts one piece out of it.
#pragma once

#include <span>
#include <vector>

#include "baker/steiner/walk_length.h"
#include "foam/site_tree.h"

namespace froth {

// The line offset - 2 slope t of a ball along a ray.
struct BallLine {
  double slope, offset;

  double at(double t) const { return offset - 2 * slope * t; }
};
BallLine lineOf(const glm::vec3& site, float radius, const WalkRay& ray);

class RayCells {
 public:
  struct Interval {
    double begin, end;
  };

  RayCells() = default;
  // From the ray's origin until its transmittance falls below a walk's cut-off, with half of each ball solid.
  RayCells(const SiteTree& tree, std::span<const glm::vec3> sites, std::span<const float> radii,
           std::span<const float> densities, const WalkRay& ray);

  size_t count() const { return pieces_.size(); }

  // Where the ray is in a cell and outside its ball, and thus outside all balls: up to two intervals per cell.
  std::vector<Interval> emptyIntervals() const;

  // An empty cell: it never ends a walk. Whether the ray would cross it, how many cells fewer the walk would then have
  // (-1 at least; 0 if it is not crossed), and its addition.
  bool isCutBy(const BallLine& ball) const { return !cutOf(ball).isEmpty; }
  int savingOf(const BallLine& ball) const;
  void add(const BallLine& ball);

 private:
  struct Piece {
    BallLine line;
    double begin;
  };
  // Where a ball lies below the envelope: it cuts off the end of `left` (-1: none) and the begin of `right`
  // (count: none).
  struct Cut {
    int left, right;
    double begin, end;
    bool isEmpty = true;
  };

  double endOf(int piece) const {
    return piece + 1 < static_cast<int>(pieces_.size()) ? pieces_[piece + 1].begin : end_;
  }
  Cut cutOf(const BallLine& ball) const;

  std::vector<Piece> pieces_;  // slopes ascend
  double end_ = 0;
};

}  // namespace froth
