#include "baker/graph/orthosphere.h"

#include <cmath>

namespace froth {
namespace {

// Every product below passes through fewer than 32 roundings of 2^-53: 1 for each difference of two floats, 6
// for a squared length with its radii, 3 for a component of a cross product, a handful for sums; the longest
// chain, the moment of a triangle, has 1 + 6 + 2 * 4 + 8. Errors are thus below 2^-48 of the sum of the
// products' magnitudes, whose own rounding the other half of the factor 2 up to here covers. No product
// leaves the range of double: at most six factors, each a float's or a sum of a few.
constexpr double kTermSlack = 0x1p-47;

// A vector or a number, and the sum of the magnitudes of the products that it was summed from.
template <class Value>
struct Summed {
  Value value, terms;
};

Summed<glm::dvec3> cross(const Summed<glm::dvec3>& a, const Summed<glm::dvec3>& b) {
  const glm::dvec3 &p = a.terms, &q = b.terms;
  return {glm::cross(a.value, b.value), {p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x}};
}

Summed<double> dot(const Summed<glm::dvec3>& a, const Summed<glm::dvec3>& b) {
  return {glm::dot(a.value, b.value), glm::dot(a.terms, b.terms)};
}

Summed<glm::dvec3> difference(const Ball& from, const Ball& to) {
  const glm::dvec3 value = to.site - from.site;
  return {value, glm::abs(value)};
}

// |d|^2 - (r^2 - r_0^2)
Summed<double> liftedHeight(const glm::dvec3& d, double radius, double firstRadius) {
  const double squared = glm::dot(d, d);
  const double weight = (radius - firstRadius) * (radius + firstRadius);
  return {squared - weight, squared + std::abs(weight)};
}

Summed<glm::dvec3> operator*(const Summed<double>& a, const Summed<glm::dvec3>& b) {
  return {a.value * b.value, a.terms * b.terms};
}

Summed<glm::dvec3> operator+(const Summed<glm::dvec3>& a, const Summed<glm::dvec3>& b) {
  return {a.value + b.value, a.terms + b.terms};
}

}  // namespace

PowerForm::PowerForm(const Ball& first, double scale, double scaleTerms, const glm::dvec3& moment,
                     const glm::dvec3& momentTerms)
    : origin_(first.site),
      radius_(first.radius),
      scale_(std::max(scale, 0.0)),  // the exact one is not negative, so this is no farther from it
      scaleError_(kTermSlack * (scaleTerms + scale_)),
      moment_(moment),
      momentError_(kTermSlack * (momentTerms + glm::abs(moment))),
      centre_(scale_ > 0
                  ? moment / (2 * scale_)
                  : glm::mix(glm::dvec3(-INFINITY), glm::dvec3(INFINITY), glm::greaterThan(moment, glm::dvec3(0)))) {}

// The centre solves 2 c . d_i = h_i, h_i = |d_i|^2 - (r_i^2 - r_0^2): by Cramer's rule
// 2 c = (h_1 d_2 x d_3 + h_2 d_3 x d_1 + h_3 d_1 x d_2) / (d_1 . d_2 x d_3).
PowerForm PowerForm::ofTetrahedron(const std::array<Ball, 4>& balls) {
  std::array<Summed<glm::dvec3>, 3> d;
  std::array<Summed<double>, 3> heights;
  for (int i = 0; i < 3; ++i) {
    d[i] = difference(balls[0], balls[i + 1]);
    heights[i] = liftedHeight(d[i].value, balls[i + 1].radius, balls[0].radius);
  }
  const Summed<glm::dvec3> across = cross(d[1], d[2]);
  const Summed<double> volume = dot(d[0], across);
  const Summed<glm::dvec3> moment =
      heights[0] * across + heights[1] * cross(d[2], d[0]) + heights[2] * cross(d[0], d[1]);
  return {balls[0], volume.value, volume.terms, moment.value, moment.terms};
}

// With n = d_1 x d_2 and c . n = 0: 2 c = (h_1 d_2 x n + h_2 n x d_1) / |n|^2.
PowerForm PowerForm::ofTriangle(const std::array<Ball, 3>& balls) {
  const Summed<glm::dvec3> d1 = difference(balls[0], balls[1]), d2 = difference(balls[0], balls[2]);
  const Summed<glm::dvec3> normal = cross(d1, d2);
  const Summed<double> squared = dot(normal, normal);
  const Summed<glm::dvec3> moment = liftedHeight(d1.value, balls[1].radius, balls[0].radius) * cross(d2, normal) +
                                    liftedHeight(d2.value, balls[2].radius, balls[0].radius) * cross(normal, d1);
  return {balls[0], squared.value, squared.terms, moment.value, moment.terms};
}

PowerForm PowerForm::beyondTriangle(const std::array<Ball, 3>& balls) {
  const Summed<glm::dvec3> normal = cross(difference(balls[0], balls[1]), difference(balls[0], balls[2]));
  return {balls[0], 0, 0, normal.value, normal.terms};
}

PowerForm::Bounds PowerForm::at(const glm::vec3& site, float radius) const {
  const glm::dvec3 x = glm::dvec3(site) - origin_;
  const Summed<double> height = liftedHeight(x, radius, radius_);
  const double value = scale_ * height.value - glm::dot(moment_, x);
  const double error = scaleError_ * height.terms + glm::dot(momentError_, glm::abs(x));
  return {value - error, value + error};
}

// With x and c from the site of ball 0,
//   f >= scale (|x - c|^2 - r^2 - (|c|^2 - r_0^2)) - scaleError (|x|^2 + r^2 + r_0^2) - momentError . |x|.
// If scaleError <= kNarrow scale and |momentError| <= kNarrow scale l, l^2 = |c|^2 + r_0^2, the errors are, by
// |x| <= |x - c| + |c| and ab <= (a^2 + b^2) / 2, below 4 kNarrow scale (|x - c|^2 + r^2 + l^2); the rounding of c in
// the scene's coordinates, at most kNarrow l, adds less than as much again. Dividing by 1 + 8 kNarrow leaves kReach.
std::optional<OuterSphere> PowerForm::outerSphere() const {
  constexpr double kNarrow = 0x1p-24;
  const double squaredLength = glm::dot(centre_, centre_) + radius_ * radius_, length = std::sqrt(squaredLength);
  const glm::dvec3 centre = origin_ + centre_;
  const double rounding = 0x1p-50 * (glm::length(origin_) + length);
  if (!(scaleError_ <= kNarrow * scale_ && glm::length(momentError_) <= kNarrow * scale_ * length &&
        rounding <= kNarrow * length)) {
    return std::nullopt;
  }
  const double squaredRadius = glm::dot(centre_, centre_) - radius_ * radius_;
  return OuterSphere{centre, squaredRadius + 32 * kNarrow * squaredLength};
}

double PowerForm::lowerOver(const SiteBox& box) const {
  const glm::dvec3 low = glm::dvec3(box.low) - origin_, high = glm::dvec3(box.high) - origin_;
  const glm::dvec3 reach = glm::max(glm::abs(low), glm::abs(high));
  const glm::dvec3 x = glm::clamp(centre_, low, high);
  const double weight = double{box.maxRadius} * box.maxRadius + radius_ * radius_;
  const double height = glm::dot(x, x) - (box.maxRadius - radius_) * (box.maxRadius + radius_);
  const double error = scaleError_ * (glm::dot(reach, reach) + weight) + glm::dot(momentError_, reach);
  return scale_ * height - glm::dot(moment_, x) - error;
}

}  // namespace froth
