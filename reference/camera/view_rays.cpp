#include "reference/camera/view_rays.h"

#include <algorithm>

#include "reference/camera/ray_map.h"
#include "shaders/foam/lens.h"

namespace froth {
namespace {

static_assert(static_cast<int>(LensKind::kFisheye) == foam::kLensFisheye &&
              static_cast<int>(LensKind::kKannalaBrandt) == foam::kLensKannalaBrandt &&
              static_cast<int>(LensKind::kRadialTangential) == foam::kLensRadialTangential &&
              static_cast<int>(LensKind::kEquirectangular) == foam::kLensEquirectangular &&
              static_cast<int>(LensKind::kOrthographic) == foam::kLensOrthographic &&
              static_cast<int>(LensKind::kRayMap) == foam::kLensRayMap);

// The direction of the pixel that holds the point, or 0.
glm::dvec3 mappedDirection(const RayMap& map, double x, double y) {
  const auto column = static_cast<size_t>(std::clamp(x, 0.0, map.width - 1.0));
  const auto row = static_cast<size_t>(std::clamp(y, 0.0, map.height - 1.0));
  return map.directions[row * map.width + column];
}

}  // namespace

ViewRays::ViewRays(const View& view) : view_(view) {
  const std::vector<double>& distortion = view.lens.distortion;
  for (size_t i = 0; i < distortion.size(); ++i) {
    (i < 4 ? first_ : second_)[static_cast<int>(i % 4)] = distortion[i];
  }
  range_ = foam::lensRange(static_cast<int>(view.lens.kind), first_, second_);
}

std::optional<ViewRay> ViewRays::at(double x, double y) const {
  const glm::dvec2 point((x - view_.cx) / view_.fx, (y - view_.cy) / view_.fy);
  glm::dvec3 direction;
  if (view_.lens.kind == LensKind::kRayMap) {
    direction = mappedDirection(*view_.lens.rays, x, y);
    if (direction == glm::dvec3(0)) return std::nullopt;
  } else if (!foam::lensRay(static_cast<int>(view_.lens.kind), point, first_, second_, range_, direction)) {
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
