#include "runtime/context/stream_eyes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "format/to_vector.h"

namespace froth {
namespace {

constexpr double kNearestPart = 1e-3;  // of an asset's diagonal

// By clipFromView: its rows of x and y are in half viewports.
void takeProjection(const FrothCamera& camera, SeenFrom& seen) {
  const float* clip = camera.clipFromView;
  const double along = std::max(std::abs(double{clip[0]}) * camera.viewport.width,
                                std::abs(double{clip[5]}) * std::abs(camera.viewport.height));
  const double depth = std::hypot(clip[3], clip[7], clip[11]);  // w by a step along the view's depth
  (depth > 0 ? seen.pixelAngle : seen.pixelSize) = 2 * (depth > 0 ? depth : std::abs(double{clip[15]})) / along;
}

// Of a point in clip coordinates: -w <= x <= w and -w <= y <= w, by the margin wider.
void takeSight(const FrothCamera& camera, SeenFrom& seen) {
  const float* clip = camera.clipFromView;
  const glm::dmat3 worldFromView = glm::transpose(glm::dmat3(glm::make_mat3(camera.viewFromWorld)));
  const auto row = [&](int i) { return glm::dvec4(clip[i], clip[i + 4], clip[i + 8], clip[i + 12]); };
  size_t side = 0;
  for (const glm::dvec4& across : {row(0), -row(0), row(1), -row(1)}) {
    const glm::dvec4 plane = (1 + 2 * kSightMargin) * row(3) + across;
    seen.sight[side++] = {worldFromView * glm::dvec3(plane), plane.w};
  }
}

}  // namespace

SeenFrom seenFrom(const FrothRenderInfo& info) {
  const FrothCamera& camera = info.camera;
  SeenFrom seen;
  std::copy(std::begin(camera.eye), std::end(camera.eye), seen.position.begin());
  seen.mask = info.mask;
  const double focal = std::max(camera.lens.focal[0], camera.lens.focal[1]);
  if (camera.lens.kind == FROTH_LENS_PROJECTION) {
    takeProjection(camera, seen);
    takeSight(camera, seen);
  } else if (camera.lens.kind != FROTH_LENS_RAY_MAP && focal > 0) {
    seen.pixelAngle = 1 / focal;
  } else {
    seen.pixelAngle = std::numbers::pi / 2 / camera.viewport.width;
  }
  return seen;
}

StreamEye eyeOf(const SeenFrom& from, const RenderInstance& instance, const GpuAsset& asset) {
  const std::array<float, 4>& q = instance.rotation;
  const glm::dquat assetFromWorld = glm::inverse(glm::dquat(q[3], q[0], q[1], q[2]));
  const double scale = instance.scale;
  const double diagonal = glm::length(toVector(asset.boundsHigh) - toVector(asset.boundsLow));
  StreamEye eye;
  eye.position = assetFromWorld * (toVector(from.position) - toVector(instance.position)) / scale;
  eye.radius = from.radius / scale;
  eye.pixelAngle = from.pixelAngle;
  eye.pixelSize = std::max(from.pixelSize / scale, from.pixelAngle * kNearestPart * diagonal);
  eye.detail = from.detail;
  for (size_t side = 0; side < eye.sight.size(); ++side) {
    const SightPlane& plane = from.sight[side];
    eye.sight[side] = {assetFromWorld * plane.normal, plane.offset / scale};
  }
  return eye;
}

}  // namespace froth
