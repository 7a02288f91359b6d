#include "baker/bake/solid_balls.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "baker/graph/half_space.h"
#include "baker/graph/solid_body.h"
#include "foam/foam.h"

namespace froth {
namespace {

// By how much the surfaces of the solid part are moved outwards [radii]; and how much larger the rounding of a plane's
// offset is in a shader than in the baker, whose slack stands for 16 roundings of 2^-53: 64 of 2^-24.
constexpr double kSolidMargin = 0x1p-8;
constexpr double kFloatSlack = 0x1p31;

// The lattice: steps of a centre and of a radius in a cell's radius.
constexpr double kCentreSteps = 32, kRadiusSteps = 64;
// A ball must lose that many steps of radius to be worth its bytes.
constexpr int kLeastGain = 2;

constexpr int kMostIterations = 32;
constexpr double kPrecision = 0.01;  // of the radius, before the lattice

uint32_t packBytes(const glm::ivec3& centre, int radius) {
  uint32_t bytes = static_cast<uint32_t>(radius) << 24;
  for (int axis = 0; axis < 3; ++axis) bytes |= static_cast<uint32_t>(centre[axis] + 32) << (8 * axis);
  return bytes;
}

// Bounds one cell after the other.
class SolidBallMaker {
 public:
  SolidBallMaker(const ChunkContents& chunk, uint32_t detailCount) : chunk_(chunk), detailCount_(detailCount) {}

  uint32_t make(uint32_t cell) {
    setBody(cell);
    glm::dvec3 centre;
    if (!findCentre(centre)) return kWholeBall;
    const glm::ivec3 place = descend(glm::ivec3(glm::round(centre * kCentreSteps)));
    const int radius = static_cast<int>(std::ceil(reachFrom(place) * kRadiusSteps));
    return radius > kRadiusSteps - kLeastGain ? kWholeBall : packBytes(place, radius);
  }

  bool isHeldBy(uint32_t cell, uint32_t ball) {
    if (ball == kWholeBall) return true;
    setBody(cell);
    const glm::ivec3 place = glm::ivec3(ball & 0xff, ball >> 8 & 0xff, ball >> 16 & 0xff) - 32;
    return reachFrom(place) * kRadiusSteps <= ball >> 24;
  }

 private:
  void setBody(uint32_t cell) {
    halfSpaces_.clear();
    const uint32_t row = chunk_.neighbourOffsets[cell];
    for (uint32_t i = row; i < row + chunk_.alphaCounts[cell]; ++i) {
      HalfSpace plane = makeHalfSpace(chunk_.sites, chunk_.radii, cell, chunk_.neighbours[i]);
      plane.offset += kSolidMargin + kFloatSlack * (plane.slack - kPolygonSlack);
      halfSpaces_.push_back(plane);
    }
    const glm::dvec3 normal = faceFrame<double>(chunk_.orientations[cell]).normal;
    const double length = glm::length(normal);
    halfSpaces_.push_back({normal / length, largestHeight(cell) / length + kSolidMargin, 0});
    body_.set(1 + kSolidMargin, halfSpaces_);
  }

  // That of the cell, which counts for readers of layer 0, is a mean of those of its detail sites, rounded.
  double largestHeight(uint32_t cell) const {
    double largest = chunk_.cellHeights.empty() ? 0 : std::max(chunk_.cellHeights[cell], 0.0f);
    if (chunk_.detailHeights.empty()) return largest;
    const auto first = chunk_.detailHeights.begin() + std::ptrdiff_t{cell} * detailCount_;
    return std::max<double>(largest, *std::max_element(first, first + detailCount_));
  }

  // About the centre of the smallest ball around the body, by Frank and Wolfe's method: the centre is a mean of points
  // of the body, and moves towards the farthest one. For such a mean c = sum w p the number sum w |p|^2 - |c|^2 is a
  // lower bound of the squared radius of any ball around the points. False if it shows that there is nothing to gain.
  bool findCentre(glm::dvec3& best) const {
    constexpr double kWorthless = 1 - kLeastGain / kRadiusSteps;
    best = glm::dvec3(0);
    double bestReach = INFINITY;
    glm::dvec3 centre = body_.farthestFrom(best);
    double meanSquare = glm::dot(centre, centre);
    for (int i = 0; i < kMostIterations; ++i) {
      const glm::dvec3 farthest = body_.farthestFrom(centre);
      const double squaredReach = glm::dot(farthest - centre, farthest - centre);
      if (squaredReach < bestReach * bestReach) {
        bestReach = std::sqrt(squaredReach);
        best = centre;
      }
      const double bound = std::max(meanSquare - glm::dot(centre, centre), 0.0);
      if (bound >= kWorthless * kWorthless) return false;
      if (bestReach - std::sqrt(bound) < kPrecision) return true;
      const double step = (squaredReach - bound) / (2 * squaredReach);
      centre += step * (farthest - centre);
      meanSquare += step * (glm::dot(farthest, farthest) - meanSquare);
    }
    return true;
  }

  double reachFrom(const glm::ivec3& place) const {
    const glm::dvec3 centre = glm::dvec3(place) / kCentreSteps;
    return glm::distance(body_.farthestFrom(centre), centre);
  }

  // To the lattice point that no neighbour along an axis betters.
  glm::ivec3 descend(glm::ivec3 place) const {
    place = glm::clamp(place, -32, 32);
    double least = reachFrom(place);
    for (bool hasMoved = true; hasMoved;) {
      hasMoved = false;
      for (int k = 0; k < 6; ++k) {
        glm::ivec3 next = place;
        next[k / 2] += k % 2 == 0 ? 1 : -1;
        if (std::abs(next[k / 2]) > 32) continue;
        const double reach = reachFrom(next);
        if (reach >= least) continue;
        least = reach;
        place = next;
        hasMoved = true;
      }
    }
    return place;
  }

  const ChunkContents& chunk_;
  const uint32_t detailCount_;
  std::vector<HalfSpace> halfSpaces_;
  SolidBody body_;
};

}  // namespace

std::vector<uint32_t> makeSolidBalls(const ChunkContents& chunk, uint32_t detailCount) {
  std::vector<uint32_t> balls(chunk.liveCount);
  tbb::parallel_for(tbb::blocked_range<uint32_t>(0, chunk.liveCount, 256),
                    [&](const tbb::blocked_range<uint32_t>& range) {
                      SolidBallMaker maker(chunk, detailCount);
                      for (uint32_t cell = range.begin(); cell < range.end(); ++cell) balls[cell] = maker.make(cell);
                    });
  return balls;
}

std::optional<uint32_t> findWrongSolidBall(const ChunkContents& chunk, uint32_t detailCount) {
  std::atomic<uint32_t> first = chunk.liveCount;
  const auto cells = static_cast<uint32_t>(chunk.solidBalls.size());
  tbb::parallel_for(tbb::blocked_range<uint32_t>(0, cells, 256), [&](const tbb::blocked_range<uint32_t>& range) {
    SolidBallMaker maker(chunk, detailCount);
    for (uint32_t cell = range.begin(); cell < range.end() && cell < first; ++cell) {
      if (maker.isHeldBy(cell, chunk.solidBalls[cell])) continue;
      uint32_t seen = first;
      while (cell < seen && !first.compare_exchange_weak(seen, cell)) {
      }
    }
  });
  return first < chunk.liveCount ? std::optional<uint32_t>(first.load()) : std::nullopt;
}

}  // namespace froth
