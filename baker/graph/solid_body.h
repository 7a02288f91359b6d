// The part of a cell in which a ray can gain opacity: a ball cut by half-spaces. Internal to the baker.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "baker/graph/half_space.h"

namespace froth {

// {x : |x| <= radius, and normal . x <= offset of all half-spaces}. Slacks are not looked at: widen the offsets before.
// One body at a time; a second one reuses the memory.
class SolidBody {
 public:
  void set(double radius, std::span<const HalfSpace> halfSpaces);

  // The point of the body that is farthest from `centre`; the origin if the body is empty.
  //
  // The distance from a point is convex, so it is greatest at an extreme point of the body: a corner of the polytope, a
  // corner where two planes meet the sphere, or a point of the sphere where it is stationary on the sphere or on the
  // circle in which a plane cuts it. Corners come from polygons clipped on each plane, so they are those of a body that
  // is off by rounding only (kPolygonSlack), however close to parallel planes are; stationary points are taken with a
  // tolerance.
  glm::dvec3 farthestFrom(const glm::dvec3& centre) const;

 private:
  // A plane that the body touches.
  struct Face {
    uint32_t halfSpace;
    double discRadius;  // of the circle in which it cuts the sphere
  };

  bool contains(const glm::dvec3& point, uint32_t exceptHalfSpace) const;
  void addCorners(const HalfSpace& plane, const PlaneAxes& axes, double discRadius);

  double radius_ = 0;
  std::vector<HalfSpace> halfSpaces_;
  std::vector<Face> faces_;
  std::vector<glm::dvec3> corners_;
  std::vector<glm::dvec2> polygon_, clipped_;
};

}  // namespace froth
