// Rays through all instances of a world, with the meeting of their foams.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "froth/froth_query.h"
#include "runtime/query/foam_walk.h"
#include "runtime/query/placement.h"

namespace froth {

struct CastSettings {
  double logQuantile, logCutoff;
  WalkLimits limits;
  bool closestOnly;
};

// Casts one ray after the other; one thread at a time.
class RayCaster {
 public:
  // `foams` and `memory` outlive it; the foams can be walked.
  RayCaster(std::span<const PlacedFoam> foams, const CastSettings& settings, std::pmr::memory_resource* memory);

  // The ray's numbers have been checked.
  FrothRayHit cast(const FrothRay& ray);

 private:
  // The segments of one foam along the ray, in world units.
  struct Stream {
    const PlacedFoam* placed;
    FoamWalk walk;
    double tBase;  // where the walk's t is 0
    FoamSegment segment;
    bool isAhead;  // the segment is one; else there are no more

    void advance();
  };

  // An interval of the ray with the same foams all along; their densities add.
  struct Interval {
    double tNear, tFar, density;
    const Stream* densest;
  };

  void startStreams(const glm::dvec3& origin, const glm::dvec3& direction, double tMin, double tMax);
  bool findInterval(double passed, Interval& interval);
  static void describePlace(const Interval& interval, const glm::dvec3& position, FrothRayHit& hit);

  std::span<const PlacedFoam> foams_;
  CastSettings settings_;
  std::pmr::vector<Stream> streams_;
};

}  // namespace froth
