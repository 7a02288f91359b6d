#include "runtime/query/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shaders/foam/compositing.h"

namespace froth {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Cuts [tNear, tFar] by the box of a foam's balls, swollen by more than rounding; false: nothing is left.
bool clipByBox(const QueryFoam& foam, const glm::dvec3& origin, const glm::dvec3& direction, double& tNear,
               double& tFar) {
  constexpr double kTiny = 1e-200;  // a direction of 0 gets a huge inverse: 0 * infinity would be NaN
  const glm::dvec3 padding = 1e-9 * (glm::abs(origin) + glm::abs(foam.low()) + glm::abs(foam.high()));
  const glm::dvec3 low = foam.low() - padding - origin, high = foam.high() + padding - origin;
  for (int axis = 0; axis < 3; ++axis) {
    const double inverse = 1 / (std::abs(direction[axis]) > kTiny ? direction[axis] : kTiny);
    tNear = std::max(tNear, std::min(low[axis] * inverse, high[axis] * inverse));
    tFar = std::min(tFar, std::max(low[axis] * inverse, high[axis] * inverse));
  }
  return tNear < tFar;
}

// Of any finite length: huge and tiny ones must not over- or underflow.
glm::dvec3 unitVector(const glm::dvec3& vector) {
  const glm::dvec3 magnitudes = glm::abs(vector);
  return glm::normalize(vector / std::max({magnitudes.x, magnitudes.y, magnitudes.z}));
}

}  // namespace

RayCaster::RayCaster(std::span<const PlacedFoam> foams, const CastSettings& settings, std::pmr::memory_resource* memory)
    : foams_(foams), settings_(settings), streams_(memory) {
  streams_.reserve(foams.size());
}

void RayCaster::Stream::advance() {
  isAhead = walk.next(segment);
  segment.tNear = tBase + segment.tNear * placed->scale;
  segment.tFar = tBase + segment.tFar * placed->scale;
  segment.density /= placed->scale;
}

// A walk begins where the ray enters the box of its foam, so that its numbers are small, however far the origin is.
void RayCaster::startStreams(const glm::dvec3& origin, const glm::dvec3& direction, double tMin, double tMax) {
  streams_.clear();
  for (const PlacedFoam& placed : foams_) {
    const glm::dvec3 localOrigin = placed.assetFromWorld(origin);
    const glm::dvec3 localDirection = glm::transpose(placed.rotation) * direction;
    double tNear = tMin / placed.scale, tFar = tMax / placed.scale;
    if (!clipByBox(*placed.foam, localOrigin, localDirection, tNear, tFar)) continue;
    const FoamRay ray{localOrigin + tNear * localDirection, localDirection, tFar - tNear};
    const FoamWalk walk(*placed.foam, ray, settings_.limits);
    streams_.push_back({&placed, walk, tNear * placed.scale, {}, false});
    streams_.back().advance();
  }
}

// The first interval beyond `passed`; false: there is none.
bool RayCaster::findInterval(double passed, Interval& interval) {
  double start = kInfinity;
  for (Stream& stream : streams_) {
    while (stream.isAhead && stream.segment.tFar <= passed) stream.advance();
    if (stream.isAhead) start = std::min(start, std::max(stream.segment.tNear, passed));
  }
  if (start == kInfinity) return false;
  interval = {start, kInfinity, 0, nullptr};
  for (const Stream& stream : streams_) {
    const FoamSegment& segment = stream.segment;
    if (!stream.isAhead) continue;
    if (segment.tNear > start) {
      interval.tFar = std::min(interval.tFar, segment.tNear);
      continue;
    }
    interval.tFar = std::min(interval.tFar, segment.tFar);
    interval.density += segment.density;
    if (!interval.densest || segment.density > interval.densest->segment.density) interval.densest = &stream;
  }
  return true;
}

FrothRayHit RayCaster::cast(const FrothRay& ray) {
  const glm::dvec3 origin(ray.origin[0], ray.origin[1], ray.origin[2]);
  const glm::dvec3 direction = unitVector({ray.direction[0], ray.direction[1], ray.direction[2]});
  startStreams(origin, direction, ray.tMin, ray.tMax == 0 ? kInfinity : ray.tMax);

  FrothRayHit hit{};
  hit.distance = kInfinity;
  double logTransmittance = 0;
  Interval interval{};
  double passed = -kInfinity;
  while (logTransmittance >= settings_.logCutoff && findInterval(passed, interval)) {
    passed = interval.tFar;
    const double logAfter = logTransmittance - interval.density * (interval.tFar - interval.tNear);
    const bool isHit = logTransmittance >= settings_.logQuantile && logAfter < settings_.logQuantile;
    if (isHit) {
      hit.distance = foam::quantileDistance(interval.tNear, logTransmittance, settings_.logQuantile, interval.density);
      describePlace(interval, origin + hit.distance * direction, hit);
    }
    logTransmittance = logAfter;
    if (isHit && settings_.closestOnly) break;
  }
  hit.transmittance = static_cast<float>(std::exp(logTransmittance));
  for (const Stream& stream : streams_) {
    hit.steps += stream.walk.steps();
    if (stream.walk.hitLimit()) hit.bits |= FROTH_QUERY_STEP_LIMIT;
  }
  return hit;
}

void RayCaster::describePlace(const Interval& interval, const glm::dvec3& position, FrothRayHit& hit) {
  const PlacedFoam& placed = *interval.densest->placed;
  const CellAddress cell = interval.densest->segment.cell;
  const glm::dvec3 normal = placed.rotation * placed.foam->chunk(cell.chunk).faceFrameOf(cell.cell)[0];
  for (int axis = 0; axis < 3; ++axis) {
    hit.position[axis] = position[axis];
    hit.normal[axis] = static_cast<float>(normal[axis]);
  }
  hit.instance = placed.instance;
  hit.chunk = cell.chunk;
  hit.cell = cell.cell;
}

}  // namespace froth
