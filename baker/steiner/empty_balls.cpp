#include "baker/steiner/empty_balls.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_set>

#include "base/counter_random.h"

namespace froth {
namespace {

constexpr double kShare = 0.25;           // of the intervals gets a candidate,
constexpr double kMostPerRay = 12;        // or so many of one ray
constexpr uint64_t kMaxIntervals = 1024;  // of one ray that are looked at
// Steps to where there is more room: few leave a ball near other balls, many bring it to the middle of a gap.
// Both help.
constexpr uint64_t kMostClimbs = 12;

// Sizes. A cell's neighbours grow with the square of how much larger it is than what lies around it, and a
// step costs its neighbours. So a ball may touch cells up to kTouchingRatio times smaller; farther out it is
// kGrading of its distance, which leaves room for smaller ones between, and every ball has neighbours of
// about its own size.
constexpr double kTouchingRatio = 8;
constexpr double kGrading = 0.3;
constexpr double kLeastRatio = 0.5;  // to the nearest cell's radius; smaller ones save nothing

// The gap that keeps a Steiner ball out of the alpha-complex. With f = r / c < 1 the radical plane passes a
// ball of radius R at distance c by at least c^2 (1 - f^2) / (2 (R + c)). The alpha-complex takes a plane for
// a cut within R 2^-35 (its slacks, doubled), so c >= 2^-13 R suffices at 1 - f^2 >= 2^-6, with room to
// spare.
constexpr double kFilling = 1 - 0x1p-7;
constexpr double kLeastClearance = 0x1p-13;  // of the largest radius

constexpr double kTwinDistance = 0.4;  // of a radius

}  // namespace

EmptyBallFinder::EmptyBallFinder(const SiteTree& tree, std::span<const glm::vec3> sites, std::span<const float> radii,
                                 const SteinerOptions& options)
    : tree_(tree), sites_(sites), radii_(radii), options_(options), low_(sites[0]), high_(sites[0]) {
  for (const glm::vec3& site : sites) {
    low_ = glm::min(low_, site);
    high_ = glm::max(high_, site);
  }
  leastClearance_ = kLeastClearance * *std::max_element(radii.begin(), radii.end());
}

void EmptyBallFinder::findAlong(const WalkRay& ray, const RayCells& cells, uint64_t stream,
                                std::vector<EmptyBall>& found) const {
  const CounterRandom random(options_.seed, Purpose::kSite);
  const std::vector<RayCells::Interval> intervals = cells.emptyIntervals();
  const size_t count = std::min<size_t>(intervals.size(), kMaxIntervals);
  const double share = std::min(kShare, kMostPerRay / static_cast<double>(count));
  for (size_t i = 0; i < count; ++i) {
    const uint64_t draw = 3 * (stream * kMaxIntervals + i);
    if (random.uniform(draw) >= share) continue;
    const double t = random.uniform(draw + 1, intervals[i].begin, intervals[i].end);
    const glm::dvec3 point = glm::dvec3(ray.origin) + t * glm::dvec3(ray.direction);
    addBall(climb(point, static_cast<uint32_t>(random.bits(draw + 2) % (kMostClimbs + 1))), found);
  }
}

// Away from the nearest ball, to where there is more room.
EmptyBallFinder::Place EmptyBallFinder::climb(const glm::dvec3& start, uint32_t tries) const {
  Place place{start, tree_.findNearestBall(start)};
  double step = 0.5 * place.nearest.value;
  for (uint32_t k = 0; k < tries && step > 0; ++k) {
    const uint32_t ball = place.nearest.site;
    const glm::dvec3 ahead = place.point + step * glm::normalize(place.point - glm::dvec3(sites_[ball]));
    const NearestSite nearest = tree_.findNearestBall(ahead, ball);
    if (nearest.value > place.nearest.value) {
      place = {ahead, nearest};
    } else {
      step *= 0.5;
    }
  }
  return place;
}

void EmptyBallFinder::addBall(const Place& place, std::vector<EmptyBall>& found) const {
  const glm::vec3 site(snapToStep(place.point.x, options_.positionStep),
                       snapToStep(place.point.y, options_.positionStep),
                       snapToStep(place.point.z, options_.positionStep));
  if (site != glm::clamp(site, low_, high_)) return;
  const NearestSite nearest = tree_.findNearestBall(site, place.nearest.site);
  const double clearance = nearest.value, neighbour = radii_[nearest.site];
  if (!(clearance >= leastClearance_)) return;
  const double wanted = std::min(kFilling * clearance, std::max(kTouchingRatio * neighbour, kGrading * clearance));
  const float radius = floorMantissa(static_cast<float>(wanted), options_.radiusBits);
  if (radius >= kLeastRatio * neighbour) found.push_back({site, radius});
}

void dropTwins(std::vector<EmptyBall>& balls) {
  using Place = std::array<double, 4>;  // whole numbers
  struct Hash {
    size_t operator()(const Place& place) const {
      uint64_t bits = 0;
      for (const double coordinate : place) bits = mixBits(bits + std::bit_cast<uint64_t>(coordinate + 0.0));
      return bits;
    }
  };
  std::unordered_set<Place, Hash> taken;
  std::erase_if(balls, [&](const EmptyBall& ball) {
    const double size = std::floor(2 * std::log2(ball.radius));  // in half powers of two
    const glm::dvec3 place = glm::floor(glm::dvec3(ball.site) / (kTwinDistance * std::exp2(0.5 * size)));
    return !taken.insert({size, place.x, place.y, place.z}).second;
  });
}

}  // namespace froth
