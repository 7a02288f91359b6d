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

// Whether the sphere around the solid stays clear of the segment from `origin` of `length` along `direction`.
bool missesBounds(const Shape& shape, const dvec3& origin, const dvec3& direction, double length, double margin) {
  const double radius = shape.boundingRadius() + margin;
  if (radius == kNoHit) return false;
  const dvec3 toCentre = shape.centre() - origin;
  const double along = std::clamp(glm::dot(toCentre, direction), 0.0, length);
  const dvec3 apart = toCentre - along * direction;
  return glm::dot(apart, apart) > radius * radius;
}

}  // namespace

std::optional<SceneHit> AnalyticScene::intersect(const Ray& ray) const {
  SceneHit hit{kNoHit, nullptr, {}};
  for (const Solid& solid : solids_) {
    const bool embossed = solid.material.reliefBound > 0;
    if (missesBounds(*solid.shape, ray.origin, ray.direction, hit.distance, solid.material.reliefBound)) continue;
    if (opening_ && solid.shape->boundingRadius() == kNoHit) {
      const double wall = solid.shape->intersect(ray, 0);
      if (wall != kNoHit && opening_->contains(ray.origin + wall * ray.direction)) continue;
    }
    double t = solid.shape->intersect(ray, solid.material.reliefBound);
    if (t >= hit.distance) continue;
    if (embossed) t = marchRelief(solid, ray, t);
    if (t < hit.distance) hit = {t, &solid, ray.origin + t * ray.direction};
  }
  if (!hit.solid) return {};
  return hit;
}

bool AnalyticScene::isShadowed(const dvec3& from, const dvec3& to) const {
  const double length = glm::length(to - from);
  const Ray ray{from, (to - from) / length};
  return std::any_of(solids_.begin(), solids_.end(), [&](const Solid& solid) {
    return solid.castsShadows && !missesBounds(*solid.shape, from, ray.direction, length, 0) &&
           solid.shape->intersect(ray, 0) < length;
  });
}

double AnalyticScene::softVisibility(const dvec3& from, const dvec3& to, double softness) const {
  constexpr int kMaxSteps = 40;
  const double length = glm::length(to - from);
  const dvec3 direction = (to - from) / length;
  double visibility = 1;
  for (const Solid& solid : solids_) {
    if (!solid.castsShadows || missesBounds(*solid.shape, from, direction, length, softness * length)) continue;
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

bool AnalyticScene::isCovered(const dvec3& x, const Solid& solid, double margin) const {
  if (opening_ && solid.shape->boundingRadius() == kNoHit && opening_->contains(x)) return true;
  return std::any_of(solids_.begin(), solids_.end(), [&](const Solid& other) {
    const double radius = other.shape->boundingRadius();
    if (&other == &solid || radius == kNoHit) return false;
    const dvec3 apart = x - other.shape->centre();
    return glm::dot(apart, apart) < (radius + margin) * (radius + margin) && other.shape->distance(x) < margin;
  });
}

double AnalyticScene::clearance(const dvec3& x, double reach) const {
  double clearance = reach;
  for (const Solid& solid : solids_) {
    const double radius = solid.shape->boundingRadius();
    if (radius != kNoHit && glm::length(x - solid.shape->centre()) - radius > clearance) continue;
    clearance = std::min(clearance, solid.shape->distance(x));
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
