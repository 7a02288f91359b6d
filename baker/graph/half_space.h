// Half-spaces that bound a cell, in units of its radius and from its site. Internal to the baker.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

struct HalfSpace {
  glm::dvec3 normal;  // unit
  double offset;      // the half-space is normal . x <= offset
  double slack;       // > rounding of offset
};

// What a neighbour leaves to a cell: the cell's side of their radical plane.
HalfSpace makeHalfSpace(std::span<const glm::vec3> sites, std::span<const float> radii, uint32_t cell,
                        uint32_t neighbour);

// Two axes that complete a unit normal to an orthonormal frame.
struct PlaneAxes {
  glm::dvec3 u, v;
};
PlaneAxes planeAxes(const glm::dvec3& normal);

// Keeps the part of a convex polygon, of one corner at least, where across . x <= limit. `clipped` is scratch.
void clipPolygon(std::vector<glm::dvec2>& polygon, const glm::dvec2& across, double limit,
                 std::vector<glm::dvec2>& clipped);

// Rounding of a polygon: 8 of 2^-53 per cut, within the unit ball; enough for 2^14 cuts of one polygon.
inline constexpr double kPolygonSlack = 0x1p-36;

}  // namespace froth
