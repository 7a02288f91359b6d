#include "baker/appearance/observations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "foam/detail_colour.h"

namespace froth {
namespace {

constexpr float kBrightest = 1.5f;  // display-coded; images end at 1, blends may need a little more

// Eyes that stand around each camera.
struct EyeAround {
  float distance;  // in distances from the camera to the nearest other one
  float share;     // weight relative to the camera
};
constexpr std::array<EyeAround, 2> kAround = {{{0.5f, 0.3f}, {2.5f, 0.2f}}};

constexpr float kRegionShare = 0.5f;  // weight of a region's eyes, relative to the views

constexpr float kHemisphereShare = 0.01f;  // weight of the whole hemisphere beside cameras, in typical detail sites
constexpr uint32_t kDirectionsBesideCameras = 24;
constexpr uint32_t kDirectionsWithoutCameras = 48;  // 20 degrees apart: as far as lobes of trained foams change

// A golden spiral, even in solid angle, about +z.
std::vector<glm::vec3> spreadHemisphere(uint32_t count) {
  std::vector<glm::vec3> directions(count);
  constexpr double kTurn = 2.399963229728653;
  for (uint32_t i = 0; i < count; ++i) {
    const double z = 1 - (i + 0.5) / count, s = std::sqrt(1 - z * z), angle = i * kTurn;
    directions[i] = glm::dvec3(s * std::cos(angle), s * std::sin(angle), z);
  }
  return directions;
}

float distanceToNearest(const std::vector<glm::vec3>& eyes, const glm::vec3& eye) {
  float nearest = std::numeric_limits<float>::max();
  for (const glm::vec3& other : eyes) {
    const float distance = glm::distance(other, eye);
    if (distance > 0) nearest = std::min(nearest, distance);
  }
  return nearest < std::numeric_limits<float>::max() ? nearest : 0;
}

// One eye per camera, each in another direction.
std::vector<glm::vec3> placeEyesAround(const std::vector<glm::vec3>& eyes, float distance, size_t firstDirection) {
  constexpr uint32_t kSideDirections = 24;
  constexpr size_t kStride = 7;  // has no divisor in common with the number of directions: neighbours differ
  const std::vector<glm::vec3> directions = spreadHemisphere(kSideDirections);
  std::vector<glm::vec3> around(eyes.size());
  for (size_t i = 0; i < eyes.size(); ++i) {
    const float side = i % 2 ? -distance : distance;
    around[i] = eyes[i] +
                side * distanceToNearest(eyes, eyes[i]) * directions[(i * kStride + firstDirection) % kSideDirections];
  }
  return around;
}

}  // namespace

glm::dvec3 meanColour(const Observations& seen) {
  glm::dvec3 sum(0);
  for (size_t i = 0; i < seen.size(); ++i) sum += double(seen.weights[i]) * glm::dvec3(seen.colours[i]);
  return sum / totalWeight(seen);
}

double totalWeight(const Observations& seen) {
  double sum = 0;
  for (float weight : seen.weights) sum += weight;
  return sum;
}

Observer::Observer(const Foam& foam, const Visibility* visibility, float eyeRadius, std::vector<float> viewWeights,
                   float weight)
    : foam_(foam),
      visibility_(visibility),
      viewWeights_(std::move(viewWeights)),
      hemisphere_(spreadHemisphere(visibility ? kDirectionsBesideCameras : kDirectionsWithoutCameras)),
      weight_(weight) {
  static_assert(kAround.size() == kEyesAround);
  if (!visibility) return;
  double sum = 0, shares = 1;
  for (uint32_t e = 0; e < kEyesAround; ++e) {
    eyesAround_[e] = placeEyesAround(visibility->eyes, kAround[e].distance, 12 * e);
    shares += kAround[e].share;
  }
  if (eyeRadius >= 0) {
    region_.emplace(foam, *visibility, eyeRadius);
    shares += kRegionShare;
  }
  uint64_t seen = 0;
  for (size_t i = 0; i < visibility->weights.size(); ++i) {
    sum += double(visibility->weights[i]) * viewWeight(visibility->views[i]);
  }
  for (size_t i = 0; i + 1 < visibility->offsets.size(); ++i) {
    seen += visibility->offsets[i + 1] > visibility->offsets[i];
  }
  if (sum > 0) typicalWeight_ = sum * shares / static_cast<double>(seen) / double{weight};
}

Observations Observer::observe(uint64_t detail) const {
  const uint64_t cell = detail / foam_.detailCount;
  const FaceFrame<float> frame = faceFrame<float>(foam_.orientations[cell]);
  const glm::vec2 place = foam_.detailSites[detail] * foam_.radii[cell];
  const glm::vec3 position = foam_.sites[cell] + place.x * frame.tangent + place.y * frame.bitangent;
  Observations seen;
  if (visibility_) addCameras(detail, position, seen);
  addHemisphere(frame, seen);
  if (region_) addRegion(detail, position, frame, seen);
  seen.colours.reserve(seen.size());
  for (const glm::vec3& direction : seen.directions) {
    seen.colours.push_back(glm::min(detailColour(foam_, detail, direction), kBrightest));
  }
  return seen;
}

std::optional<uint32_t> Observer::viewOfEye(uint32_t eye) const {
  if (!visibility_ || eye % (1 + kEyesAround) != 0) return {};
  const uint32_t view = eye / (1 + kEyesAround);
  return view < visibility_->eyes.size() ? std::optional(view) : std::nullopt;
}

float Observer::overlap(uint32_t cell, uint32_t k, uint32_t l) const {
  if (!visibility_ || visibility_->overlaps.empty()) return 0;
  if (k > l) std::swap(k, l);
  const uint64_t K = foam_.detailCount, before = k * K - k * (k + 1) / 2;  // pairs of the rows above
  return visibility_->overlaps[cell * (K * (K - 1) / 2) + before + (l - k - 1)];
}

void Observer::addCameras(uint64_t detail, const glm::vec3& position, Observations& seen) const {
  const auto add = [&](uint32_t number, const glm::vec3& eye, double weight) {
    const glm::vec3 fromEye = position - eye;
    const float distance = glm::length(fromEye);
    const auto relative = static_cast<float>(weight / typicalWeight_);
    if (!(distance > 0) || !(relative > 0)) return;
    seen.eyes.push_back(number);
    seen.directions.push_back(fromEye / distance);
    seen.weights.push_back(relative);
  };
  const uint64_t row = detail / visibility_->detailsPerRow;
  for (uint64_t i = visibility_->offsets[row]; i < visibility_->offsets[row + 1]; ++i) {
    const uint32_t view = visibility_->views[i], number = view * (1 + kEyesAround);
    const float weight = viewWeight(view) * visibility_->weights[i];
    add(number, visibility_->eyes[view], weight);
    for (uint32_t e = 0; e < kEyesAround; ++e) add(number + 1 + e, eyesAround_[e][view], kAround[e].share * weight);
  }
}

void Observer::addRegion(uint64_t detail, const glm::vec3& position, const FaceFrame<float>& frame,
                         Observations& seen) const {
  double shown = 0;
  for (uint64_t i = visibility_->offsets[detail]; i < visibility_->offsets[detail + 1]; ++i) {
    shown += double(viewWeight(visibility_->views[i])) * visibility_->weights[i];
  }
  const auto first = static_cast<uint32_t>(visibility_->eyes.size() * (1 + kEyesAround) + hemisphere_.size());
  for (const RegionEyes::Sight& sight : region_->sightsOf(detail, position, frame, shown)) {
    const auto relative = static_cast<float>(kRegionShare * sight.weight / typicalWeight_);
    if (!(relative > 0)) continue;
    seen.eyes.push_back(first + sight.eye);
    seen.directions.push_back(sight.direction);
    seen.weights.push_back(relative);
  }
}

void Observer::addHemisphere(const FaceFrame<float>& frame, Observations& seen) const {
  const float weight = weight_ * (visibility_ ? kHemisphereShare : 1) * 2 / static_cast<float>(hemisphere_.size());
  uint32_t number = visibility_ ? static_cast<uint32_t>(visibility_->eyes.size()) * (1 + kEyesAround) : 0;
  for (const glm::vec3& d : hemisphere_) {
    seen.eyes.push_back(number++);
    seen.directions.push_back(d.x * frame.tangent + d.y * frame.bitangent - d.z * frame.normal);
    seen.weights.push_back(weight * d.z);  // as large as the face looks from there
  }
}

}  // namespace froth
