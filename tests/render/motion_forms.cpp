#include "tests/render/motion_forms.h"

#include <cmath>

#include "reference/camera/view_rays.h"

namespace froth::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

FrothInstanceInfo infoOf(const Pose& pose) {
  const glm::dquat& q = pose.rotation;
  return placementOf(pose.position, glm::dvec4(q.x, q.y, q.z, q.w), static_cast<float>(pose.scale));
}

glm::dvec3 toWorld(const Pose& pose, const glm::dvec3& point) {
  return pose.position + pose.rotation * (pose.scale * point);
}

glm::dvec3 toAsset(const Pose& pose, const glm::dvec3& point) {
  return glm::inverse(pose.rotation) * (point - pose.position) / pose.scale;
}

View lensView(LensKind kind, const glm::dvec3& eye, const glm::dvec3& target) {
  View view = lookAt(eye, target, kMotionWidth, kMotionHeight, 0.5);
  view.lens.kind = kind;
  view.fx = view.fy = kind == LensKind::kPinhole ? 85 : kind == LensKind::kOrthographic ? 32 : 60;
  if (kind == LensKind::kKannalaBrandt) view.lens.distortion = {-0.021, 0.0088, -0.0056, 0.0008};
  if (kind == LensKind::kRadialTangential) view.lens.distortion = {-0.2, 0.05, -0.0011, 0.0023};
  if (kind == LensKind::kEquirectangular) {
    view.fx = kMotionWidth / (2 * kPi);
    view.fy = kMotionHeight / kPi;
  }
  return view;
}

glm::dvec2 pixelOf(const View& view, const glm::dvec3& place, bool isDirection) {
  const glm::dvec3 world = isDirection ? place : place - eyeOf(view);
  glm::dvec3 v;
  for (int row = 0; row < 3; ++row) {
    const auto& m = view.worldFromCamera;
    v[row] = m[row] * world.x + m[4 + row] * world.y + m[8 + row] * world.z;
  }
  const double r = std::hypot(v.x, v.y), theta = std::atan2(r, v.z);
  const std::vector<double>& k = view.lens.distortion;
  glm::dvec2 point(v.x, v.y);
  switch (view.lens.kind) {
    case LensKind::kFisheye:
      point *= theta / r;
      break;
    case LensKind::kKannalaBrandt:
      point *= (theta + k[0] * std::pow(theta, 3) + k[1] * std::pow(theta, 5) + k[2] * std::pow(theta, 7) +
                k[3] * std::pow(theta, 9)) /
               r;
      break;
    case LensKind::kRadialTangential: {
      const double x = v.x / v.z, y = v.y / v.z, r2 = x * x + y * y, radial = 1 + k[0] * r2 + k[1] * r2 * r2;
      point = {x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x),
               y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y};
      break;
    }
    case LensKind::kEquirectangular:
      point = {std::atan2(v.x, v.z), std::atan2(v.y, std::hypot(v.x, v.z))};
      break;
    case LensKind::kOrthographic:
      break;
    default:
      point /= v.z;
  }
  return {view.cx + view.fx * point.x, view.cy + view.fy * point.y};
}

FrothRenderInfo infoOf(const Moved& moved) {
  FrothRenderInfo info = infoOf(moved.now);
  info.previousCamera = infoOf(moved.before).camera;
  return info;
}

}  // namespace froth::test
