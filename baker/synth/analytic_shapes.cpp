#include "baker/synth/analytic_shapes.h"

#include <algorithm>
#include <cmath>

namespace froth {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

namespace {

// First root > 0 of the ray with a sphere; `inner` asks for the exit instead of the entry.
double intersectSphere(const Ray& ray, const dvec3& centre, double radius, bool inner) {
  const dvec3 toCentre = centre - ray.origin;
  const double along = glm::dot(toCentre, ray.direction);
  const dvec3 perpendicular = toCentre - along * ray.direction;
  const double halfChordSquared = radius * radius - glm::dot(perpendicular, perpendicular);
  if (halfChordSquared <= 0) return kNoHit;
  const double t = inner ? along + std::sqrt(halfChordSquared) : along - std::sqrt(halfChordSquared);
  return t > 0 ? t : kNoHit;
}

}  // namespace

dmat3 frameAround(const dvec3& z) {
  const dvec3 helper = std::abs(z.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
  const dvec3 x = glm::normalize(glm::cross(helper, z));
  return {x, glm::cross(z, x), z};
}

Cuboid::Cuboid(const dvec3& centre, const dvec3& halfExtent, Empty empty, uint32_t faces, const dmat3& axes)
    : centre_(centre), halfExtent_(halfExtent), side_(empty == Empty::kOutside ? 1 : -1), faces_(faces), axes_(axes) {}

double Cuboid::distance(const dvec3& x) const {
  const dvec3 beyond = glm::abs((x - centre_) * axes_) - halfExtent_;
  const dvec3 outside = glm::max(beyond, dvec3(0));
  return side_ * (glm::length(outside) + std::min(std::max({beyond.x, beyond.y, beyond.z}), 0.0));
}

SurfacePoint Cuboid::pointOnFace(const dvec3& local, uint32_t face) const {
  const int axis = static_cast<int>(face / 2);
  const double sign = face % 2 ? 1 : -1;
  SurfacePoint point;
  point.local = local;
  point.local[axis] = sign * halfExtent_[axis];
  point.position = centre_ + axes_ * point.local;
  point.normal = side_ * sign * axes_[axis];
  point.tangent = axes_[(axis + 1) % 3];
  point.face = face;
  return point;
}

SurfacePoint Cuboid::nearest(const dvec3& x) const {
  const dvec3 local = (x - centre_) * axes_;
  const dvec3 beyond = glm::abs(local) - halfExtent_;
  const int axis = beyond.x > beyond.y ? (beyond.x > beyond.z ? 0 : 2) : (beyond.y > beyond.z ? 1 : 2);
  return pointOnFace(local, 2 * static_cast<uint32_t>(axis) + (local[axis] > 0 ? 1 : 0));
}

double Cuboid::intersect(const Ray& ray, double swell) const {
  const dvec3 origin = (ray.origin - centre_) * axes_;
  const dvec3 direction = ray.direction * axes_;
  // Open faces do not swell: what they border on is not there.
  const auto extentTowards = [&](int axis, double sign) {
    const bool open = side_ < 0 && !(faces_ >> (2 * axis + (sign > 0 ? 1 : 0)) & 1);
    return halfExtent_[axis] + (open ? 0.0 : side_ * swell);
  };
  double enter = -kNoHit, leave = kNoHit;
  uint32_t leaveFace = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (std::abs(origin[axis]) > extentTowards(axis, origin[axis])) return kNoHit;
      continue;
    }
    const double sign = direction[axis] > 0 ? 1 : -1;
    enter = std::max(enter, (-sign * extentTowards(axis, -sign) - origin[axis]) / direction[axis]);
    const double exit = (sign * extentTowards(axis, sign) - origin[axis]) / direction[axis];
    if (exit < leave) {
      leave = exit;
      leaveFace = 2 * static_cast<uint32_t>(axis) + (sign > 0 ? 1 : 0);
    }
  }
  if (enter >= leave || leave <= 0) return kNoHit;
  if (side_ > 0) return enter > 0 ? enter : kNoHit;
  return faces_ >> leaveFace & 1 ? leave : kNoHit;
}

double Cuboid::boundingRadius() const { return side_ > 0 ? glm::length(halfExtent_) : kNoHit; }

double Sphere::distance(const dvec3& x) const { return glm::length(x - centre_) - radius_; }

SurfacePoint Sphere::nearest(const dvec3& x) const {
  const dvec3 normal = glm::normalize(x - centre_);
  return {centre_ + radius_ * normal, normal, frameAround(normal)[0], radius_ * normal, 0};
}

double Sphere::intersect(const Ray& ray, double swell) const {
  return intersectSphere(ray, centre_, radius_ + swell, false);
}

Backdrop::Backdrop(const dvec3& centre, double radius, const dvec3& axis, double halfAngle)
    : centre_(centre), axis_(axis), radius_(radius), cosHalfAngle_(std::cos(halfAngle)) {}

double Backdrop::distance(const dvec3& x) const { return radius_ - glm::length(x - centre_); }

SurfacePoint Backdrop::nearest(const dvec3& x) const {
  const dvec3 outwards = glm::normalize(x - centre_);
  return {centre_ + radius_ * outwards, -outwards, frameAround(outwards)[0], radius_ * outwards, 0};
}

double Backdrop::intersect(const Ray& ray, double swell) const {
  const double t = intersectSphere(ray, centre_, radius_ - swell, true);
  if (t == kNoHit) return kNoHit;
  const dvec3 outwards = (ray.origin + t * ray.direction - centre_) / radius_;
  return glm::dot(outwards, axis_) >= cosHalfAngle_ ? t : kNoHit;
}

Torus::Torus(const dvec3& centre, const dvec3& axis, double majorRadius, double minorRadius)
    : centre_(centre), axes_(frameAround(axis)), major_(majorRadius), minor_(minorRadius) {}

double Torus::distance(const dvec3& x) const {
  const dvec3 local = (x - centre_) * axes_;
  return glm::length(dvec2(glm::length(dvec2(local)) - major_, local.z)) - minor_;
}

SurfacePoint Torus::pointAt(const dvec3& local) const {
  const dvec2 around = glm::normalize(dvec2(local));
  const dvec3 ringCentre(major_ * around, 0);
  const dvec3 normal = glm::normalize(local - ringCentre);
  SurfacePoint point;
  point.local = ringCentre + minor_ * normal;
  point.position = centre_ + axes_ * point.local;
  point.normal = axes_ * normal;
  point.tangent = axes_ * dvec3(-around.y, around.x, 0);
  return point;
}

SurfacePoint Torus::nearest(const dvec3& x) const { return pointAt((x - centre_) * axes_); }

// Sphere tracing: the distance is exact, so steps of its full length never overshoot.
double Torus::intersect(const Ray& ray, double swell) const {
  constexpr double kClose = 1e-6;
  constexpr int kMaxSteps = 200;
  const double bound = boundingRadius() + swell;
  const double last = intersectSphere(ray, centre_, bound, true);
  if (last == kNoHit) return kNoHit;
  const double first = intersectSphere(ray, centre_, bound, false);
  double t = first == kNoHit ? 0 : first;
  for (int step = 0; step < kMaxSteps && t < last; ++step) {
    const double clearance = distance(ray.origin + t * ray.direction) - swell;
    if (clearance < kClose) return t > kClose ? t : kNoHit;
    t += clearance;
  }
  return kNoHit;
}

double Cylinder::distance(const dvec3& x) const {
  const dvec3 local = x - base_;
  const dvec2 beyond(glm::length(dvec2(local)) - radius_, local.z - height_);
  return glm::length(glm::max(beyond, dvec2(0))) + std::min(std::max(beyond.x, beyond.y), 0.0);
}

SurfacePoint Cylinder::nearest(const dvec3& x) const {
  const dvec3 local = x - base_;
  const double radial = glm::length(dvec2(local));
  const dvec2 around = radial > 0 ? dvec2(local) / radial : dvec2(1, 0);
  SurfacePoint point;
  if (local.z - height_ > radial - radius_) {
    point.local = {local.x, local.y, height_};
    point.normal = {0, 0, 1};
    point.face = 1;
  } else {
    point.local = {radius_ * around, local.z};
    point.normal = {around, 0};
  }
  point.tangent = {-around.y, around.x, 0};
  point.position = base_ + point.local;
  return point;
}

double Cylinder::intersect(const Ray& ray, double swell) const {
  const dvec3 origin = ray.origin - base_;
  const double radius = radius_ + swell, top = height_ + swell;
  double enter = -kNoHit, leave = kNoHit;
  const double a = glm::dot(dvec2(ray.direction), dvec2(ray.direction));
  const double b = glm::dot(dvec2(origin), dvec2(ray.direction));
  const double c = glm::dot(dvec2(origin), dvec2(origin)) - radius * radius;
  if (a > 0) {
    const double discriminant = b * b - a * c;
    if (discriminant <= 0) return kNoHit;
    enter = (-b - std::sqrt(discriminant)) / a;
    leave = (-b + std::sqrt(discriminant)) / a;
  } else if (c > 0) {
    return kNoHit;
  }
  if (ray.direction.z != 0) {
    const double atFoot = -origin.z / ray.direction.z, atTop = (top - origin.z) / ray.direction.z;
    enter = std::max(enter, std::min(atFoot, atTop));
    leave = std::min(leave, std::max(atFoot, atTop));
  }
  return enter < leave && enter > 0 ? enter : kNoHit;
}

double Cylinder::boundingRadius() const { return std::hypot(radius_, 0.5 * height_); }

}  // namespace froth
