// How shapes cover themselves with sites: about one site per spacing^2, and a radius that reaches the corners
// of the Voronoi patches.
#include <algorithm>
#include <cmath>

#include "baker/synth/analytic_shapes.h"
#include "baker/synth/golden_angle.h"

namespace froth {

using glm::dvec2;
using glm::dvec3;

namespace {

// Exact lattices have four sites on a circle everywhere; a little jitter makes them ordinary.
constexpr double kJitter = 0.05;

// Places along an edge of `length`, symmetric, the outermost `margin` away from the ends, or one in the
// middle of an edge of about two margins.
std::vector<double> placeAlong(double length, double margin, double spacing) {
  const auto count = static_cast<int>(std::max(length > 3 * margin ? 2.0 : 1.0, std::round(length / spacing)));
  if (count == 1) return {0.0};
  std::vector<double> places(static_cast<size_t>(count));
  const double step = (length - 2 * margin) / (count - 1);
  for (int i = 0; i < count; ++i) places[static_cast<size_t>(i)] = -0.5 * length + margin + i * step;
  return places;
}

// Sites of a spherical cap around `axis` along a golden spiral, which has no poles and no seam.
void placeOnCap(const dvec3& centre, double radius, const dvec3& axis, double cosHalfAngle, double facing,
                double spacing, std::vector<SurfaceSite>& sites) {
  const double area = glm::two_pi<double>() * radius * radius * (1 - cosHalfAngle);
  const double count = std::max(12.0, std::round(area / (spacing * spacing)));
  const glm::dmat3 frame = frameAround(axis);
  for (double i = 0; i < count; ++i) {
    const double z = 1 - (1 - cosHalfAngle) * (i + 0.5) / count;
    const double across = std::sqrt(1 - z * z);
    const dvec3 outwards = frame * dvec3(across * std::cos(kGoldenAngle * i), across * std::sin(kGoldenAngle * i), z);
    // The widest patches of the spiral reach 0.74 of sqrt(area per site).
    sites.push_back(
        {centre + radius * outwards, facing * outwards, frameAround(outwards)[0], 0.8 * std::sqrt(area / count)});
  }
}

}  // namespace

void Cuboid::placeSites(double spacing, const CounterRandom& random, std::vector<SurfaceSite>& sites) const {
  const dvec3 extent = 2.0 * halfExtent_;
  const double thickness = std::min({extent.x, extent.y, extent.z});
  // All edges share one margin; a thin bar is a whole number of rows thick, and may be sparser along its
  // length.
  const double row = thickness / std::max(1.0, std::round(thickness / spacing));
  const double margin = 0.5 * row;
  const double stride = std::clamp(spacing, row, 2.5 * row);
  std::vector<double> places[3];
  double widest[3];
  for (int axis = 0; axis < 3; ++axis) {
    places[axis] = placeAlong(extent[axis], margin, stride);
    const std::vector<double>& p = places[axis];
    widest[axis] = p.size() == 1 ? extent[axis] : std::max(p[1] - p[0], row);
  }
  std::sort(widest, widest + 3);
  const double radius = 0.5 * std::hypot(widest[1], widest[2]) + 2 * kJitter * row;

  for (uint32_t face = 0; face < 6; ++face) {
    if (!(faces_ >> face & 1)) continue;
    const int axis = static_cast<int>(face / 2), u = (axis + 1) % 3, v = (axis + 2) % 3;
    const size_t countU = places[u].size(), countV = places[v].size();
    for (size_t j = 0; j < countV; ++j) {
      for (size_t i = 0; i < countU; ++i) {
        const bool onEdgeRow = i == 0 || j == 0 || i + 1 == countU || j + 1 == countV;
        const double jitter = onEdgeRow ? 0 : kJitter * row;
        const uint64_t draw = 2 * sites.size();
        dvec3 local(0);
        local[u] = places[u][i] + random.uniform(draw, -jitter, jitter);
        local[v] = places[v][j] + random.uniform(draw + 1, -jitter, jitter);
        const SurfacePoint point = pointOnFace(local, face);
        sites.push_back({point.position, point.normal, point.tangent, radius});
      }
    }
  }
}

void Sphere::placeSites(double spacing, const CounterRandom&, std::vector<SurfaceSite>& sites) const {
  placeOnCap(centre_, radius_, {0, 0, 1}, -1, 1, spacing, sites);
}

void Backdrop::placeSites(double spacing, const CounterRandom&, std::vector<SurfaceSite>& sites) const {
  placeOnCap(centre_, radius_, axis_, cosHalfAngle_, -1, spacing, sites);
}

void Torus::placeSites(double spacing, const CounterRandom& random, std::vector<SurfaceSite>& sites) const {
  const double ringCount = std::max(6.0, std::round(glm::two_pi<double>() * minor_ / spacing));
  for (double ring = 0; ring < ringCount; ++ring) {
    const double tube = glm::two_pi<double>() * ring / ringCount;
    const double ringRadius = major_ + minor_ * std::cos(tube);
    const double count = std::max(6.0, std::round(glm::two_pi<double>() * ringRadius / spacing));
    const double phase = random.uniform(static_cast<uint64_t>(ring));
    for (double i = 0; i < count; ++i) {
      const double angle = glm::two_pi<double>() * (i + phase) / count;
      const SurfacePoint point =
          pointAt({ringRadius * std::cos(angle), ringRadius * std::sin(angle), minor_ * std::sin(tube)});
      const double across = glm::two_pi<double>() * std::max(ringRadius / count, minor_ / ringCount);
      sites.push_back({point.position, point.normal, point.tangent, 0.8 * across});
    }
  }
}

void Cylinder::placeSites(double spacing, const CounterRandom& random, std::vector<SurfaceSite>& sites) const {
  const double aroundCount = std::max(8.0, std::round(glm::two_pi<double>() * radius_ / spacing));
  const double step = glm::two_pi<double>() * radius_ / aroundCount;
  const double radius = 0.8 * step;
  const auto addRing = [&](double count, double phase, double ringRadius, double z, bool top) {
    for (double i = 0; i < count; ++i) {
      const double angle = glm::two_pi<double>() * (i + phase) / count;
      const dvec2 around(std::cos(angle), std::sin(angle));
      sites.push_back({base_ + dvec3(ringRadius * around, z), top ? dvec3(0, 0, 1) : dvec3(around, 0),
                       dvec3(-around.y, around.x, 0), radius});
    }
  };
  const double rows = std::max(1.0, std::round(height_ / step));
  for (double row = 0; row < rows; ++row) {
    // The topmost ring mirrors the outermost ring of the top across the edge, at half a step from it.
    const double z = height_ - 0.5 * step - row * (height_ - step) / std::max(1.0, rows - 1);
    addRing(aroundCount, 0.5 * std::fmod(row, 2.0), radius_, z, false);
  }
  addRing(aroundCount, 0, radius_ - 0.5 * step, height_, true);
  double ringRadius = radius_ - 1.5 * step;
  for (uint64_t ring = 0; ringRadius > 0.3 * step; ++ring, ringRadius -= step) {
    addRing(std::max(3.0, std::round(glm::two_pi<double>() * ringRadius / step)), random.uniform(ring), ringRadius,
            height_, true);
  }
  if (ringRadius > -0.3 * step) addRing(1, 0, 0, height_, true);
}

}  // namespace froth
