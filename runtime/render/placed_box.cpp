#include "runtime/render/placed_box.h"

#include "format/to_vector.h"

namespace froth {
namespace {

// Rays, and places of cells, lose less than this part of the distance to rounding.
constexpr double kGuard = 1e-5;

}  // namespace

double PlacedBox::reachAlong(const glm::dvec3& axis) const {
  const glm::dvec3 parts = glm::abs(glm::transpose(axes) * axis) * half;
  return parts.x + parts.y + parts.z;
}

PlacedBox boxOf(const RenderInstance& instance, const glm::dvec3& eye) {
  const glm::dvec3 low = toVector(instance.asset->boundsLow), high = toVector(instance.asset->boundsHigh);
  PlacedBox box;
  box.axes = rotationOf(instance.rotation);
  box.centre = toVector(instance.position) - eye + box.axes * (0.5 * double{instance.scale} * (low + high));
  box.half = 0.5 * double{instance.scale} * (high - low);
  return box;
}

RayPyramid::RayPyramid(const FrothCamera& camera, const CameraRays& rays) {
  if (lensClassOf(camera) != gpu::kLensClassPinhole) return;
  const double width = camera.scissor.extent.width, height = camera.scissor.extent.height;
  const auto rayOf = [&](double column, double row) { return rays.origin + column * rays.stepX + row * rays.stepY; };
  const std::array<glm::dvec3, 4> corners{rayOf(-1, -1), rayOf(width, -1), rayOf(width, height), rayOf(-1, height)};
  const glm::dvec3 middle = rayOf(0.5 * width, 0.5 * height);
  for (size_t side = 0; side < 4; ++side) {
    const glm::dvec3 normal = glm::normalize(glm::cross(corners[side], corners[(side + 1) % 4]));
    inwards_[side] = glm::dot(normal, middle) < 0 ? -normal : normal;
  }
}

bool RayPyramid::mayMeet(const PlacedBox& box) const {
  const double guard = kGuard * (glm::length(box.centre) + glm::length(box.half));
  for (const glm::dvec3& inwards : inwards_) {
    if (glm::dot(inwards, box.centre) + box.reachAlong(inwards) < -guard) return false;
  }
  return true;
}

}  // namespace froth
