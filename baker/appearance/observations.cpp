#include "baker/appearance/observations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "shaders/foam/appearance.h"

namespace froth {
namespace {

constexpr float kBrightest = 1.5f;        // display-coded; images end at 1, blends may need a little more
constexpr float kBesideShare = 0.3f;      // weight of the eye beside a camera, relative to the camera
constexpr float kBesideDistance = 0.5f;   // in distances to the nearest other camera
constexpr float kHemisphereShare = 0.01f; // weight of the whole hemisphere beside cameras, in typical detail sites
constexpr uint32_t kHemisphereDirections = 24;

// Directions at which a face is seen, against its normal: a golden spiral that is even in solid angle.
// x, y along the tangents, z against the normal.
std::array<glm::vec3, kHemisphereDirections> spreadHemisphere() {
  std::array<glm::vec3, kHemisphereDirections> directions;
  constexpr double kGoldenAngle = 2.399963229728653;
  for (uint32_t i = 0; i < kHemisphereDirections; ++i) {
    const double z = 1 - (i + 0.5) / kHemisphereDirections, s = std::sqrt(1 - z * z), angle = i * kGoldenAngle;
    directions[i] = glm::dvec3(s * std::cos(angle), s * std::sin(angle), z);
  }
  return directions;
}

// An eye near each camera, in a direction that differs from camera to camera.
std::vector<glm::vec3> placeEyesBeside(const std::vector<glm::vec3>& eyes) {
  const auto hemisphere = spreadHemisphere();
  std::vector<glm::vec3> beside(eyes.size());
  for (size_t i = 0; i < eyes.size(); ++i) {
    float nearest = std::numeric_limits<float>::max();
    for (const glm::vec3& other : eyes) {
      const float distance = glm::distance(other, eyes[i]);
      if (distance > 0) nearest = std::min(nearest, distance);
    }
    if (nearest == std::numeric_limits<float>::max()) nearest = 0;
    const float sign = i % 2 ? -1.0f : 1.0f;
    beside[i] = eyes[i] + sign * kBesideDistance * nearest * hemisphere[i * 7 % kHemisphereDirections];
  }
  return beside;
}

}  // namespace

Observer::Observer(const Foam& foam, const Visibility* visibility) : foam_(foam), visibility_(visibility) {
  if (!visibility) return;
  eyesBeside_ = placeEyesBeside(visibility->eyes);
  double sum = 0;
  uint64_t seen = 0;
  for (float weight : visibility->weights) sum += weight;
  for (size_t i = 0; i + 1 < visibility->offsets.size(); ++i) seen += visibility->offsets[i + 1] > visibility->offsets[i];
  if (sum > 0) typicalWeight_ = sum * (1 + kBesideShare) / static_cast<double>(seen);
}

Observations Observer::observe(uint64_t site) const {
  const uint64_t cell = site / foam_.detailCount;
  const FaceFrame<float> frame = faceFrame<float>(foam_.orientations[cell]);
  const glm::vec2 place = foam_.detailSites[site] * foam_.radii[cell];
  const glm::vec3 position = foam_.sites[cell] + place.x * frame.tangent + place.y * frame.bitangent;
  Observations seen;
  if (visibility_) addCameras(site, position, seen);
  addHemisphere(site, frame, seen);
  seen.colours.reserve(seen.size());
  for (const glm::vec3& direction : seen.directions) seen.colours.push_back(colourAlong(site, direction));
  return seen;
}

void Observer::addCameras(uint64_t site, const glm::vec3& position, Observations& seen) const {
  const auto add = [&](const glm::vec3& eye, double weight) {
    const glm::vec3 fromEye = position - eye;
    const float distance = glm::length(fromEye);
    if (!(distance > 0)) return;
    seen.directions.push_back(fromEye / distance);
    seen.weights.push_back(static_cast<float>(weight / typicalWeight_));
  };
  for (uint64_t i = visibility_->offsets[site]; i < visibility_->offsets[site + 1]; ++i) {
    add(visibility_->eyes[visibility_->views[i]], visibility_->weights[i]);
    add(eyesBeside_[visibility_->views[i]], kBesideShare * visibility_->weights[i]);
  }
}

void Observer::addHemisphere(uint64_t, const FaceFrame<float>& frame, Observations& seen) const {
  static const auto kHemisphere = spreadHemisphere();
  const float weight = (visibility_ ? kHemisphereShare : 1.0f) / kHemisphereDirections;
  for (const glm::vec3& d : kHemisphere) {
    seen.directions.push_back(d.x * frame.tangent + d.y * frame.bitangent - d.z * frame.normal);
    seen.weights.push_back(weight);
  }
}

glm::vec3 Observer::colourAlong(uint64_t site, const glm::vec3& direction) const {
  const LobeRange lobes = lobesOf(foam_, site);
  float largest = -std::numeric_limits<float>::max(), weightSum = 0;
  glm::vec3 colourSum(0);
  for (uint64_t m = lobes.first; m < lobes.first + lobes.count; ++m) {
    foam::addLobe(foam::lobeExponent(foam_.lobeAxes[m], direction), foam_.lobeColours[m], largest, weightSum, colourSum);
  }
  const glm::vec3 base = foam_.baseColours.empty() ? glm::vec3(0) : foam_.baseColours[site];
  return glm::min(foam::lobeColour(base, weightSum, colourSum), kBrightest);
}

}  // namespace froth
