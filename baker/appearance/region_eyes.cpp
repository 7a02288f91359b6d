#include "baker/appearance/region_eyes.h"

#include <algorithm>
#include <cmath>

#include "base/counter_random.h"

namespace froth {
namespace {

constexpr double kLeastOpenness = 0.05;  // relative to the mean: what no view shows is coded too
constexpr uint32_t kLeastEyes = 48;      // of a cell: few cameras may have a large region around them
constexpr uint64_t kSampledDetails = 16384;
constexpr uint64_t kEyeSeed = 1;

// How large a face of this radius looks along `fromEye`, up to a factor; 0 from behind.
double facing(const glm::vec3& fromEye, float distance, const glm::vec3& normal, float radius) {
  const double cosine = -glm::dot(fromEye, normal) / distance, r = radius, d = distance;
  return cosine > 0 ? cosine * r * r / (d * d + r * r) : 0;
}

}  // namespace

RegionEyes::RegionEyes(const Foam& foam, const Visibility& visibility, float radius)
    : foam_(foam),
      visibility_(visibility),
      radius_(radius),
      eyeCount_(std::max(static_cast<uint32_t>(visibility.eyes.size()), kLeastEyes)) {
  const uint64_t allDetails = visibility.offsets.size() - 1, count = std::min(allDetails, kSampledDetails);
  double shown = 0, faced = 0;
  for (uint64_t i = 0; i < count; ++i) {
    const uint64_t detail = i * allDetails / count, cell = detail / foam.detailCount;
    double weight = 0;
    for (uint64_t k = visibility.offsets[detail]; k < visibility.offsets[detail + 1]; ++k) {
      weight += visibility.weights[k];
    }
    if (!(weight > 0)) continue;
    shown += weight;
    faced += sumFacing(cell, foam.sites[cell], faceFrame<float>(foam.orientations[cell]));
  }
  if (faced > 0) leastOpenness_ = kLeastOpenness * shown / faced;
}

double RegionEyes::sumFacing(uint64_t cell, const glm::vec3& position, const FaceFrame<float>& frame) const {
  double sum = 0;
  for (const glm::vec3& eye : visibility_.eyes) {
    const glm::vec3 fromEye = position - eye;
    const float distance = glm::length(fromEye);
    if (distance > 0) sum += facing(fromEye, distance, frame.normal, foam_.radii[cell]);
  }
  return sum;
}

std::vector<RegionEyes::Sight> RegionEyes::sightsOf(uint64_t detail, const glm::vec3& position,
                                                    const FaceFrame<float>& frame, double shown) const {
  const uint64_t cell = detail / foam_.detailCount, viewCount = visibility_.eyes.size();
  const double faced = sumFacing(cell, position, frame);
  const double openness = std::max(faced > 0 ? shown / faced : 0, leastOpenness_);
  const CounterRandom direction(kEyeSeed, Purpose::kEye), distance(kEyeSeed, Purpose::kRadius);
  std::vector<Sight> sights;
  for (uint32_t number = 0; number < eyeCount_; ++number) {
    const uint64_t index = cell * eyeCount_ + number, view = number * viewCount / eyeCount_;
    const double moved = radius_ * std::cbrt(distance.uniform(index));  // even in volume
    const glm::vec3 eye = visibility_.eyes[view] + glm::vec3(moved * direction.direction(index));
    const glm::vec3 fromEye = position - eye;
    const float length = glm::length(fromEye);
    if (!(length > 0)) continue;
    const double share = double(viewCount) / eyeCount_;
    const double weight = share * openness * facing(fromEye, length, frame.normal, foam_.radii[cell]);
    if (weight > 0) sights.push_back({number, fromEye / length, weight});
  }
  return sights;
}

}  // namespace froth
