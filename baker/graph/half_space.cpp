#include "baker/graph/half_space.h"

#include <cmath>

#include "shaders/foam/cell.h"

namespace froth {
namespace {

// Rounding of a plane's offset, in units of r: 8 roundings of 2^-53 on terms of the size |d|^2 + r_i^2 +
// r_j^2, divided by |d| r, doubled.
constexpr double kOffsetSlack = 0x1p-49;

}  // namespace

HalfSpace makeHalfSpace(std::span<const glm::vec3> sites, std::span<const float> radii, uint32_t cell,
                        uint32_t neighbour) {
  const glm::dvec3 toNeighbour = glm::dvec3(sites[neighbour]) - glm::dvec3(sites[cell]);
  const double distance = glm::length(toNeighbour);
  const double radius = radii[cell], neighbourRadius = radii[neighbour];
  const double scale = 1 / (distance * radius);
  const double terms = distance * distance + std::abs(radius - neighbourRadius) * (radius + neighbourRadius);
  return {toNeighbour / distance, foam::radicalOffset(toNeighbour, radius, neighbourRadius) * scale,
          kPolygonSlack + kOffsetSlack * terms * scale};
}

PlaneAxes planeAxes(const glm::dvec3& normal) {
  const glm::dvec3 axis = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(normal, axis));
  return {u, glm::cross(normal, u)};
}

void clipPolygon(std::vector<glm::dvec2>& polygon, const glm::dvec2& across, double limit,
                 std::vector<glm::dvec2>& clipped) {
  clipped.clear();
  glm::dvec2 from = polygon.back();
  double fromExcess = glm::dot(across, from) - limit;
  for (const glm::dvec2& to : polygon) {
    const double toExcess = glm::dot(across, to) - limit;
    if ((fromExcess > 0) != (toExcess > 0)) {
      clipped.push_back(from + (to - from) * (fromExcess / (fromExcess - toExcess)));
    }
    if (toExcess <= 0) clipped.push_back(to);
    from = to;
    fromExcess = toExcess;
  }
  polygon.swap(clipped);
}

}  // namespace froth
