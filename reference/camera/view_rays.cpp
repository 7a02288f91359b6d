#include "reference/camera/view_rays.h"

#include <algorithm>

#include "reference/camera/ray_map.h"

namespace froth {
namespace {

// The direction of the pixel that holds the point, or 0.
glm::dvec3 mappedDirection(const RayMap& map, double x, double y) {
  const auto column = static_cast<size_t>(std::clamp(x, 0.0, map.width - 1.0));
  const auto row = static_cast<size_t>(std::clamp(y, 0.0, map.height - 1.0));
  return map.directions[row * map.width + column];
}

}  // namespace

ViewRays::ViewRays(const View& view) : view_(view), lens_(view.lens) {}

std::optional<ViewRay> ViewRays::at(double x, double y) const {
  const glm::dvec2 point((x - view_.cx) / view_.fx, (y - view_.cy) / view_.fy);
  glm::dvec3 direction;
  if (view_.lens.kind == LensKind::kRayMap) {
    direction = mappedDirection(*view_.lens.rays, x, y);
    if (direction == glm::dvec3(0)) return std::nullopt;
  } else if (!foam::lensRay(lens_.kind, point, lens_.first, lens_.second, lens_.range, direction)) {
    return std::nullopt;
  }
  const bool isOrthographic = view_.lens.kind == LensKind::kOrthographic;
  return ViewRay{isOrthographic ? toWorld({point.x, point.y, 0}) : glm::dvec3(0), glm::normalize(toWorld(direction))};
}

glm::dvec3 ViewRays::toWorld(const glm::dvec3& d) const {
  const auto& m = view_.worldFromCamera;
  return {m[0] * d.x + m[1] * d.y + m[2] * d.z, m[4] * d.x + m[5] * d.y + m[6] * d.z,
          m[8] * d.x + m[9] * d.y + m[10] * d.z};
}

}  // namespace froth
