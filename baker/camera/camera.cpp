#include "baker/camera/camera.h"

#include <cmath>

#include "baker/camera/view_check.h"

namespace froth {
namespace {

constexpr uint32_t kMaxViewSide = 65536;
// Poses come from files with six or seven digits; a rotation further off than this is a scaled or sheared
// one.
constexpr double kRotationTolerance = 1e-4;

Error fieldError(const std::string& place, const char* field, double found, const char* remedy) {
  return makeError(ErrorKind::kBadInput, "%s, field '%s': found %.9g; %s", place.c_str(), field, found,
                   remedy);
}

Status checkRotation(const View& view, const std::string& place) {
  const auto& m = view.worldFromCamera;
  auto column = [&](int c, int row) { return m[row * 4 + c]; };
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) {
      double product = 0;
      for (int row = 0; row < 3; ++row) product += column(a, row) * column(b, row);
      if (std::abs(product - (a == b)) > kRotationTolerance) {
        return makeError(
            ErrorKind::kBadInput,
            "%s, field 'world_from_camera': the product of columns %d and %d is %.9g instead of %d; give a "
            "rotation without scale (orthonormal to 1e-4) in the first three columns",
            place.c_str(), a, b, product, a == b);
      }
    }
  }
  const double determinant = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
                             m[2] * (m[4] * m[9] - m[5] * m[8]);
  if (determinant < 0) {
    return fieldError(place, "world_from_camera", determinant,
                      "as its determinant: it mirrors; camera axes are x right, y down, z forward");
  }
  return {};
}

}  // namespace

Status checkView(const View& view, const std::string& place) {
  const std::pair<const char*, uint32_t> sides[] = {{"width", view.width}, {"height", view.height}};
  for (const auto& [field, side] : sides) {
    if (side < 1 || side > kMaxViewSide) return fieldError(place, field, side, "give 1 to 65536 pixels");
  }
  const std::pair<const char*, double> lengths[] = {{"fx", view.fx}, {"fy", view.fy}};
  for (const auto& [field, length] : lengths) {
    if (!std::isfinite(length) || length <= 0)
      return fieldError(place, field, length, "give a focal length > 0 in pixels");
  }
  const std::pair<const char*, double> centres[] = {{"cx", view.cx}, {"cy", view.cy}};
  for (const auto& [field, centre] : centres) {
    if (!std::isfinite(centre)) return fieldError(place, field, centre, "give a finite number of pixels");
  }
  const std::pair<const char*, double> limits[] = {{"near_depth", view.nearDepth.value_or(0)},
                                                   {"near_ratio", view.nearRatio.value_or(0)}};
  for (const auto& [field, limit] : limits) {
    if (!std::isfinite(limit) || limit < 0)
      return fieldError(place, field, limit, "give a number >= 0 (0: test off)");
  }
  for (double entry : view.worldFromCamera) {
    if (!std::isfinite(entry)) return fieldError(place, "world_from_camera", entry, "give finite numbers");
  }
  return checkRotation(view, place);
}

View resizeView(const View& view, uint32_t width, uint32_t height) {
  View resized = view;
  const double scaleX = double(width) / view.width, scaleY = double(height) / view.height;
  resized.width = width;
  resized.height = height;
  resized.fx *= scaleX;
  resized.cx *= scaleX;
  resized.fy *= scaleY;
  resized.cy *= scaleY;
  return resized;
}

}  // namespace froth
