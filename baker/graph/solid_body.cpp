#include "baker/graph/solid_body.h"

#include <algorithm>
#include <cmath>

namespace froth {
namespace {

constexpr uint32_t kNone = 0xffffffff;
constexpr double kTolerance = 0x1p-30;

}  // namespace

void SolidBody::set(double radius, std::span<const HalfSpace> halfSpaces) {
  radius_ = radius;
  halfSpaces_.clear();
  faces_.clear();
  corners_.clear();
  for (const HalfSpace& halfSpace : halfSpaces) {
    if (halfSpace.offset < radius) halfSpaces_.push_back(halfSpace);
  }
  for (uint32_t i = 0; i < halfSpaces_.size(); ++i) {
    const HalfSpace& plane = halfSpaces_[i];
    if (plane.offset < -radius) continue;  // the body is empty, and so is every polygon
    const PlaneAxes axes = planeAxes(plane.normal);
    const double disc = std::sqrt((radius - plane.offset) * (radius + plane.offset));
    polygon_ = {{-disc, -disc}, {disc, -disc}, {disc, disc}, {-disc, disc}};
    for (uint32_t j = 0; j < halfSpaces_.size() && !polygon_.empty(); ++j) {
      if (j == i) continue;
      const HalfSpace& other = halfSpaces_[j];
      const glm::dvec2 across(glm::dot(other.normal, axes.u), glm::dot(other.normal, axes.v));
      const double limit = other.offset - plane.offset * glm::dot(other.normal, plane.normal);
      clipPolygon(polygon_, across, limit + kPolygonSlack, clipped_);
    }
    if (polygon_.empty()) continue;
    faces_.push_back({i, disc});
    addCorners(plane, axes, disc);
  }
}

// Corners of the polygon within the circle, and where its edges meet the circle.
void SolidBody::addCorners(const HalfSpace& plane, const PlaneAxes& axes, double discRadius) {
  const double squaredRadius = discRadius * discRadius;
  const auto add = [&](const glm::dvec2& p) {
    corners_.push_back(plane.offset * plane.normal + p.x * axes.u + p.y * axes.v);
  };
  glm::dvec2 from = polygon_.back();
  for (const glm::dvec2& to : polygon_) {
    const glm::dvec2 edge = to - from;
    const double edgeEdge = glm::dot(edge, edge), fromEdge = glm::dot(from, edge);
    const double excess = glm::dot(from, from) - squaredRadius;
    if (excess <= kTolerance) add(from);
    const double discriminant = fromEdge * fromEdge - edgeEdge * excess;
    if (discriminant > 0) {
      for (const double root : {-std::sqrt(discriminant), std::sqrt(discriminant)}) {
        const double t = (-fromEdge + root) / edgeEdge;
        if (t >= 0 && t <= 1) add(from + t * edge);
      }
    }
    from = to;
  }
}

bool SolidBody::contains(const glm::dvec3& point, uint32_t exceptHalfSpace) const {
  for (uint32_t i = 0; i < halfSpaces_.size(); ++i) {
    if (i != exceptHalfSpace && glm::dot(halfSpaces_[i].normal, point) > halfSpaces_[i].offset + kTolerance) {
      return false;
    }
  }
  return true;
}

glm::dvec3 SolidBody::farthestFrom(const glm::dvec3& centre) const {
  glm::dvec3 farthest(0);
  double most = -1;
  const auto consider = [&](const glm::dvec3& point, auto&& isInBody) {
    const double squared = glm::dot(point - centre, point - centre);
    if (squared <= most || !isInBody()) return;
    most = squared;
    farthest = point;
  };
  for (const glm::dvec3& corner : corners_) consider(corner, [] { return true; });
  for (const Face& face : faces_) {
    const HalfSpace& plane = halfSpaces_[face.halfSpace];
    const glm::dvec3 across = centre - glm::dot(plane.normal, centre) * plane.normal;
    const double length = glm::length(across);
    const glm::dvec3 away = length > 0 ? across / -length : planeAxes(plane.normal).u;
    const glm::dvec3 point = plane.offset * plane.normal + face.discRadius * away;
    consider(point, [&] { return contains(point, face.halfSpace); });
  }
  const double length = glm::length(centre);
  const glm::dvec3 pole = radius_ * (length > 0 ? centre / -length : glm::dvec3(1, 0, 0));
  consider(pole, [&] { return contains(pole, kNone); });
  return farthest;
}

}  // namespace froth
