#include "reference/camera/camera.h"

#include <cmath>

#include "reference/camera/ray_map.h"
#include "reference/camera/view_check.h"

namespace froth {
namespace {

constexpr uint32_t kMaxViewSide = 65536;
// Poses come from files with six or seven digits; a rotation further off than this is a scaled or sheared
// one.
constexpr double kRotationTolerance = 1e-4;

Error fieldError(const std::string& place, const char* field, double found, const char* remedy) {
  return makeError(ErrorKind::kBadInput, "%s, field '%s': found %.9g; %s", place.c_str(), field, found, remedy);
}

Status checkIntrinsics(const View& view, const std::string& place) {
  const std::pair<const char*, double> lengths[] = {{"fx", view.fx}, {"fy", view.fy}};
  for (const auto& [field, length] : lengths) {
    if (!std::isfinite(length) || length <= 0) {
      return fieldError(place, field, length, "give a focal length > 0 in pixels");
    }
  }
  const std::pair<const char*, double> centres[] = {{"cx", view.cx}, {"cy", view.cy}};
  for (const auto& [field, centre] : centres) {
    if (!std::isfinite(centre)) return fieldError(place, field, centre, "give a finite number of pixels");
  }
  return {};
}

Status checkLens(const View& view, const std::string& place) {
  const Lens& lens = view.lens;
  const size_t count = lens.distortion.size();
  for (double coefficient : lens.distortion) {
    if (!std::isfinite(coefficient)) return fieldError(place, "distortion", coefficient, "give finite numbers");
  }
  if (lens.kind == LensKind::kKannalaBrandt && count != 4) {
    return fieldError(place, "distortion", double(count), "as the count of its numbers; give k1, k2, k3, k4");
  }
  if (lens.kind == LensKind::kRadialTangential && count != 4 && count != 5 && count != 8) {
    return fieldError(place, "distortion", double(count),
                      "as the count of its numbers; give k1, k2, p1, p2, and then k3, or k3, k4, k5, k6");
  }
  const bool isDistorted = lens.kind == LensKind::kKannalaBrandt || lens.kind == LensKind::kRadialTangential;
  if (!isDistorted && count != 0) {
    return fieldError(place, "distortion", double(count),
                      "as the count of its numbers, for a lens without any; remove it, or name its lens");
  }
  if (lens.kind == LensKind::kRayMap && lens.raysFile.empty()) {
    return makeError(ErrorKind::kBadInput, "%s, field 'rays': found nothing; name the file of the ray map",
                     place.c_str());
  }
  if (lens.rays && (lens.rays->width != view.width || lens.rays->height != view.height)) {
    return makeError(ErrorKind::kBadInput,
                     "%s, field 'rays': found %u x %u rays for %u x %u pixels; give one per pixel", place.c_str(),
                     lens.rays->width, lens.rays->height, view.width, view.height);
  }
  return lens.kind == LensKind::kRayMap ? Status() : checkIntrinsics(view, place);
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
  const double determinant =
      m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
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
  if (Status status = checkLens(view, place); !status) return status;
  const std::pair<const char*, double> limits[] = {{"near_depth", view.nearDepth.value_or(0)},
                                                   {"near_ratio", view.nearRatio.value_or(0)}};
  for (const auto& [field, limit] : limits) {
    if (!std::isfinite(limit) || limit < 0) return fieldError(place, field, limit, "give a number >= 0 (0: test off)");
  }
  for (double entry : view.worldFromCamera) {
    if (!std::isfinite(entry)) return fieldError(place, "world_from_camera", entry, "give finite numbers");
  }
  return checkRotation(view, place);
}

bool looksForward(LensKind kind) { return kind == LensKind::kPinhole || kind == LensKind::kRadialTangential; }

View resizeView(const View& view, uint32_t width, uint32_t height) {
  View resized = view;
  const double scaleX = double(width) / view.width, scaleY = double(height) / view.height;
  resized.width = width;
  resized.height = height;
  resized.fx *= scaleX;
  resized.cx *= scaleX;
  resized.fy *= scaleY;
  resized.cy *= scaleY;
  if (view.lens.rays) {
    resized.lens.rays = std::make_shared<RayMap>(resizeRayMap(*view.lens.rays, width, height));
  }
  return resized;
}

}  // namespace froth
