// Nearest points of small convex bodies: half-spaces, and a ball around the origin cut by half-spaces.
#pragma once

#include <optional>
#include <span>

#include <glm/glm.hpp>

namespace froth {

// normal . x <= offset; the normal has unit length.
struct HalfSpace {
  glm::dvec3 normal;
  double offset;
};

// The point nearest to `point` in all half-spaces; none: nothing is in all of them. Lengths near 1: a surface is as
// thick as 1e-12.
std::optional<glm::dvec3> findNearestPoint(std::span<const HalfSpace> halfSpaces, const glm::dvec3& point);

// The same in the unit ball around the origin, too.
std::optional<glm::dvec3> findNearestPointInBall(std::span<const HalfSpace> halfSpaces, const glm::dvec3& point);

}  // namespace froth
