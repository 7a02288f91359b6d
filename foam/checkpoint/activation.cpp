#include "foam/checkpoint/activation.h"

#include <cmath>
#include <initializer_list>
#include <limits>

#include "shaders/foam/activations.h"

namespace froth {
namespace {

constexpr float kRawOfZero = -2;  // exp(-200) / 100 is far below the smallest float, in double and in float arithmetic

}  // namespace

double softplus(double raw) { return foam::softplus(raw); }

float inverseSoftplus(float activated) {
  if (activated == 0) {
    return kRawOfZero;
  }
  const auto nearest = static_cast<float>(foam::softplusInverse(double{activated}));
  float best = nearest;
  double bestError = std::numeric_limits<double>::infinity();
  for (const float raw : {nearest, std::nextafter(nearest, -1e30f), std::nextafter(nearest, 1e30f)}) {
    const double error = std::abs(double{static_cast<float>(softplus(raw))} - activated);
    if (error < bestError) {
      best = raw;
      bestError = error;
    }
  }
  return best;
}

glm::vec4 normaliseQuaternion(const glm::dvec4& quaternion) {
  // Four components, each rounded by at most 2^-24 of itself, move the squared length by little over 2^-23.
  constexpr double kRounding = 0x1p-22;
  const glm::vec4 rounded(quaternion);
  if (std::abs(glm::dot(glm::dvec4(rounded), glm::dvec4(rounded)) - 1) <= kRounding) {
    return rounded;
  }
  return glm::vec4(quaternion / glm::length(quaternion));
}

}  // namespace froth
