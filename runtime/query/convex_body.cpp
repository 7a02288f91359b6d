#include "runtime/query/convex_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace froth {
namespace {

double excess(const HalfSpace& halfSpace, const glm::dvec3& x) {
  return glm::dot(halfSpace.normal, x) - halfSpace.offset;
}

// Distances at which a point counts as lying in a half-space.
double toleranceAt(const glm::dvec3& point) { return 1e-12 * (1 + glm::length(point)); }

// Nearest on the edge of a and b, in all of `others`.
std::optional<glm::dvec3> nearestOnEdge(const HalfSpace& a, const HalfSpace& b, std::span<const HalfSpace> others,
                                        const glm::dvec3& point) {
  const double cosine = glm::dot(a.normal, b.normal);
  const glm::dvec3 cross = glm::cross(a.normal, b.normal);
  const double sineSquared = glm::dot(cross, cross);
  if (!(sineSquared > 1e-24)) return std::nullopt;  // parallel and apart: nothing lies on both
  const double ea = excess(a, point), eb = excess(b, point);
  const glm::dvec3 foot = point - ((ea - cosine * eb) * a.normal + (eb - cosine * ea) * b.normal) / sineSquared;
  const glm::dvec3 along = cross / std::sqrt(sineSquared);
  const double tolerance = toleranceAt(point);
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  for (const HalfSpace& other : others) {
    const double slope = glm::dot(other.normal, along), room = -excess(other, foot);
    if (slope > 1e-12) {
      high = std::min(high, room / slope);
    } else if (slope < -1e-12) {
      low = std::max(low, room / slope);
    } else if (room < -tolerance) {
      return std::nullopt;
    }
  }
  if (low > high + tolerance) return std::nullopt;
  return foot + std::max(low, std::min(high, 0.0)) * along;
}

// Nearest on the surface of `face`, in all of `others`.
std::optional<glm::dvec3> nearestOnFace(const HalfSpace& face, std::span<const HalfSpace> others,
                                        const glm::dvec3& point) {
  glm::dvec3 nearest = point - excess(face, point) * face.normal;
  const double tolerance = toleranceAt(point);
  for (size_t i = 0; i < others.size(); ++i) {
    if (excess(others[i], nearest) <= tolerance) continue;
    const auto onEdge = nearestOnEdge(face, others[i], others.first(i), point);
    if (!onEdge) return std::nullopt;
    nearest = *onEdge;
  }
  return nearest;
}

}  // namespace

// One half-space after the other (Seidel 1991): if the nearest point so far is not in the next one, the new one lies on
// its surface, where the problem has one dimension less.
std::optional<glm::dvec3> findNearestPoint(std::span<const HalfSpace> halfSpaces, const glm::dvec3& point) {
  glm::dvec3 nearest = point;
  const double tolerance = toleranceAt(point);
  for (size_t i = 0; i < halfSpaces.size(); ++i) {
    if (excess(halfSpaces[i], nearest) <= tolerance) continue;
    const auto onFace = nearestOnFace(halfSpaces[i], halfSpaces.first(i), point);
    if (!onFace) return std::nullopt;
    nearest = *onFace;
  }
  return nearest;
}

// With a multiplier m >= 0 for the ball, |y - c|^2 + m |y|^2 is least at the point nearest to c / (1 + m): some point
// between c and the origin. The farther down that way, the nearer to the origin its nearest point: a search for the one
// on the sphere.
std::optional<glm::dvec3> findNearestPointInBall(std::span<const HalfSpace> halfSpaces, const glm::dvec3& point) {
  const auto outer = findNearestPoint(halfSpaces, point);
  if (!outer || glm::dot(*outer, *outer) <= 1) return outer;
  auto inner = findNearestPoint(halfSpaces, glm::dvec3(0));
  if (!inner || !(glm::dot(*inner, *inner) <= 1)) return std::nullopt;
  double low = 0, high = 1;  // shares of the way: outside at low, inside at high
  double lowExcess = glm::length(*outer) - 1, highExcess = glm::length(*inner) - 1;
  constexpr int kMostSteps = 60;
  constexpr double kTolerance = 1e-12;
  for (int step = 0; step < kMostSteps && high - low > kTolerance && -highExcess > kTolerance; ++step) {
    // Regula falsi, every third step a bisection.
    const double share =
        step % 3 == 2 ? 0.5 * (low + high) : (low * highExcess - high * lowExcess) / (highExcess - lowExcess);
    const auto found = findNearestPoint(halfSpaces, (1 - share) * point);
    if (!found) return inner;
    const double foundExcess = glm::length(*found) - 1;
    if (foundExcess > 0) {
      low = share;
      lowExcess = foundExcess;
    } else {
      high = share;
      highExcess = foundExcess;
      inner = found;
    }
  }
  return inner;
}

}  // namespace froth
