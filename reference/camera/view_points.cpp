#include "reference/camera/view_points.h"

#include "reference/camera/view_rays.h"

namespace froth {

ViewPoints::ViewPoints(const View& view) : view_(view), lens_(view.lens) {}

std::optional<glm::dvec2> ViewPoints::of(const glm::dvec3& place) const {
  if (view_.lens.kind == LensKind::kRayMap || view_.lens.kind == LensKind::kOrthographic) return std::nullopt;
  const auto& m = view_.worldFromCamera;
  const glm::dvec3 d = place - eyeOf(view_);
  const glm::dvec3 direction(m[0] * d.x + m[4] * d.y + m[8] * d.z, m[1] * d.x + m[5] * d.y + m[9] * d.z,
                             m[2] * d.x + m[6] * d.y + m[10] * d.z);
  glm::dvec2 point;
  if (!foam::lensPoint(lens_.kind, direction, lens_.first, lens_.second, lens_.range, point)) return std::nullopt;
  const glm::dvec2 pixel(point.x * view_.fx + view_.cx, point.y * view_.fy + view_.cy);
  const bool isInside = pixel.x >= 0 && pixel.y >= 0 && pixel.x < view_.width && pixel.y < view_.height;
  return isInside ? std::optional(pixel) : std::nullopt;
}

}  // namespace froth
