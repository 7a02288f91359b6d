// Which sites conflict with a simplex of a regular triangulation, by bounds that no rounding can break.
#pragma once

#include <array>
#include <optional>

#include <glm/glm.hpp>

#include "foam/site_tree.h"

namespace froth {

struct Ball {
  glm::dvec3 site;
  double radius;
};

// A sphere in space, as wide as rounding asks for: a site conflicts with what it stands for only if
// |p - centre|^2 kReach <= squaredRadius + r^2.
struct OuterSphere {
  static constexpr double kReach = 1 - 0x1p-18;
  glm::dvec3 centre;
  double squaredRadius;  // may be negative
};

// The power of sites with respect to a sphere, times a positive number, and what rounding may have done to
// it: f = scale (|x|^2 - (r^2 - r_0^2)) - moment . x, with x from the site of ball 0. f = 0 for the balls it
// was made of; f < 0: the site conflicts, its power cell reaches the sphere's centre. In this form a sphere
// whose centre has gone to infinity is as good as any other: scale = 0, a half-space.
class PowerForm {
 public:
  // The sphere orthogonal to four balls, positively oriented: (b - a) . ((c - a) x (d - a)) > 0.
  static PowerForm ofTetrahedron(const std::array<Ball, 4>& balls);
  // The smallest sphere orthogonal to three balls: its centre lies in their plane.
  static PowerForm ofTriangle(const std::array<Ball, 3>& balls);
  // The half-space beyond the plane of three sites, on the side of (b - a) x (c - a).
  static PowerForm beyondTriangle(const std::array<Ball, 3>& balls);

  // No site's exact value is below `lower`, or above `upper`.
  struct Bounds {
    double lower, upper;
  };
  Bounds at(const glm::vec3& site, float radius) const;

  // None for spheres that are too near a half-space for their centre to be known well.
  std::optional<OuterSphere> outerSphere() const;

  // No site of a box has a lower bound below this.
  double lowerOver(const SiteBox& box) const;

 private:
  // `scale` and `moment` are sums of products; scaleTerms and momentTerms those of their magnitudes.
  PowerForm(const Ball& first, double scale, double scaleTerms, const glm::dvec3& moment,
            const glm::dvec3& momentTerms);

  glm::dvec3 origin_;
  double radius_;
  double scale_, scaleError_;  // >= 0; errors: with the roundings of what they are multiplied with
  glm::dvec3 moment_, momentError_;
  glm::dvec3 centre_;  // where f is least
};

}  // namespace froth
