#include "baker/synth/analytic_scene.h"

#include <algorithm>
#include <cmath>

namespace froth {

using glm::dvec3;

namespace {

// Signed distance to the embossed surface, roughly: the relief is shallow and gently sloped.
double embossedDistance(const Solid& solid, const dvec3& x) {
  return solid.shape->distance(x) - solid.material.relief(solid.shape->nearest(x));
}

// Marches through the slab that the relief may fill. Steps are shortened because slopes make the distance an
// overestimate; the last step is bisected.
double marchRelief(const Solid& solid, const Ray& ray, double start) {
  constexpr int kMaxSteps = 64, kBisections = 12;
  constexpr double kCaution = 0.7;
  const double bound = solid.material.reliefBound;
  const double shortest = 0.05 * bound;
  double t = start, before = start;
  for (int step = 0; step < kMaxSteps; ++step) {
    const dvec3 x = ray.origin + t * ray.direction;
    const double gap = embossedDistance(solid, x);
    if (gap <= 0) break;
    if (step > 0 && solid.shape->distance(x) > 1.5 * bound) return kNoHit;  // left the slab again
    before = t;
    t += std::max(kCaution * gap, shortest);
  }
  for (int step = 0; step < kBisections; ++step) {
    const double middle = 0.5 * (before + t);
    (embossedDistance(solid, ray.origin + middle * ray.direction) > 0 ? before : t) = middle;
  }
  return t;
}

// Whether a sphere stays clear of the segment from `origin` of `length` along `direction`.
bool missesSphere(const dvec3& centre, double radius, const dvec3& origin, const dvec3& direction, double length) {
  const dvec3 toCentre = centre - origin;
  const double along = std::clamp(glm::dot(toCentre, direction), 0.0, length);
  const dvec3 apart = toCentre - along * direction;
  return glm::dot(apart, apart) > radius * radius;
}

}  // namespace

AnalyticScene::AnalyticScene(std::vector<Solid> solids, const Extent& room, const Extent& opening)
    : solids_(std::move(solids)), room_(room), opening_(opening) {
  for (const Solid& solid : solids_) bounds_.push_back({solid.shape->centre(), solid.shape->boundingRadius()});
}

std::optional<SceneHit> AnalyticScene::intersect(const Ray& ray) const {
  SceneHit hit{kNoHit, nullptr, {}};
  for (size_t i = 0; i < solids_.size(); ++i) {
    const Solid& solid = solids_[i];
    const double bound = solid.material.reliefBound;
    if (missesSphere(bounds_[i].centre, bounds_[i].radius + bound, ray.origin, ray.direction, hit.distance)) continue;
    if (bounds_[i].radius == kNoHit) {
      const double wall = solid.shape->intersect(ray, 0);
      if (wall != kNoHit && opening_.contains(ray.origin + wall * ray.direction)) continue;
    }
    double t = solid.shape->intersect(ray, bound);
    if (t >= hit.distance) continue;
    if (bound > 0) t = marchRelief(solid, ray, t);
    if (t < hit.distance) hit = {t, &solid, ray.origin + t * ray.direction};
  }
  if (!hit.solid) return {};
  return hit;
}

double AnalyticScene::softVisibility(const dvec3& from, const dvec3& to, double softness) const {
  constexpr int kMaxSteps = 40;
  const double length = glm::length(to - from);
  const dvec3 direction = (to - from) / length;
  double visibility = 1;
  for (size_t i = 0; i < solids_.size(); ++i) {
    const Solid& solid = solids_[i];
    if (!solid.castsShadows) continue;
    if (missesSphere(bounds_[i].centre, bounds_[i].radius + softness * length, from, direction, length)) continue;
    double narrowest = 1;
    double t = 0.01;
    for (int step = 0; step < kMaxSteps && t < length; ++step) {
      const double gap = solid.shape->distance(from + t * direction);
      narrowest = std::min(narrowest, 0.5 + 0.5 * gap / (softness * t));
      if (narrowest <= 0) break;
      t += std::max(std::abs(gap), 0.02);
    }
    narrowest = std::max(narrowest, 0.0);
    visibility *= narrowest * narrowest * (3 - 2 * narrowest);
  }
  return visibility;
}

bool AnalyticScene::isCovered(const dvec3& x, const dvec3& normal, const Solid& solid, double margin) const {
  constexpr double kSunk = -1e-4;   // [scene units] more than rounding
  constexpr double kFacing = -0.5;  // cosine between the normals of surfaces that face each other
  const bool isWall = solid.shape->boundingRadius() == kNoHit;
  if (isWall ? opening_.contains(x) : !room_.contains(x) && !opening_.contains(x)) return true;
  const size_t own = static_cast<size_t>(&solid - solids_.data());
  for (size_t i = 0; i < solids_.size(); ++i) {
    if (i == own || bounds_[i].radius == kNoHit) continue;
    if (glm::length(x - bounds_[i].centre) > bounds_[i].radius + margin) continue;
    const Shape& other = *solids_[i].shape;
    const double distance = other.distance(x);
    if (distance < kSunk) return true;
    const bool yields = (isWall || i < own) && distance < margin;
    if (yields && glm::dot(other.nearest(x).normal, normal) > kFacing) return true;
  }
  return false;
}

double AnalyticScene::clearance(const dvec3& x, double reach) const {
  double clearance = reach;
  for (size_t i = 0; i < solids_.size(); ++i) {
    const dvec3 apart = x - bounds_[i].centre;
    const double far = bounds_[i].radius + clearance;
    if (glm::dot(apart, apart) > far * far) continue;
    const double distance = solids_[i].shape->distance(x);
    // Rooms that x is not in are behind their own walls.
    if (bounds_[i].radius != kNoHit || distance >= 0) clearance = std::min(clearance, distance);
  }
  return clearance;
}

double heightAlongNormal(const Solid& solid, const dvec3& origin, const dvec3& normal) {
  constexpr int kIterations = 5;  // the normals differ little over one cell, so each divides the error by ten or more
  double height = 0;
  for (int i = 0; i < kIterations; ++i) {
    const dvec3 x = origin + height * normal;
    height -= solid.material.relief ? embossedDistance(solid, x) : solid.shape->distance(x);
  }
  return height;
}

dvec3 embossedNormal(const Solid& solid, const SurfacePoint& point) {
  if (!solid.material.relief) return point.normal;
  constexpr double kStep = 1.5e-3;  // [scene units] half a groove's rim: resolves every slope, smooths none away
  const dvec3 bitangent = glm::cross(point.normal, point.tangent);
  const auto slope = [&](const dvec3& along) {
    const double ahead = solid.material.relief(solid.shape->nearest(point.position + kStep * along));
    const double behind = solid.material.relief(solid.shape->nearest(point.position - kStep * along));
    return (ahead - behind) / (2 * kStep);
  };
  return glm::normalize(point.normal - slope(point.tangent) * point.tangent - slope(bitangent) * bitangent);
}

}  // namespace froth
