// One ray from cell to cell through the regular triangulation of an asset, in the asset's frame.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "runtime/query/query_foam.h"

namespace froth {

// t >= 0 counts from the origin [asset units].
struct FoamRay {
  glm::dvec3 origin{0}, direction{0};  // of unit length
  double tEnd = 0;
};

// Where a walk ends early: from so many cells, or neighbours of these, on.
struct WalkLimits {
  uint32_t steps, neighbours;
};

// Where a ray gains opacity in one cell: tNear < tFar <= FoamRay::tEnd.
struct FoamSegment {
  double tNear = 0, tFar = 0;
  double density = 0;  // [1 / asset unit]
  CellAddress cell;
};

// No rounding can make a walk cycle: each step has a key, the dot product of the direction and the site it leads to,
// and is taken only to a greater key; the key of a site of a chunk, be it a cell or a ghost, is one fixed number for a
// ray. In the open, where no ball is and a cell has hundreds of neighbours, a tree over the balls tells where the ray
// enters the next one; the cells before it have nothing to show.
class FoamWalk {
 public:
  FoamWalk(const QueryFoam& foam, const FoamRay& ray, const WalkLimits& limits);

  // The next segment, front to back; false: there is none up to the end of the ray or a limit.
  bool next(FoamSegment& segment);

  uint32_t steps() const { return steps_; }
  bool hitLimit() const { return hitLimit_; }

 private:
  // Neighbour through whose plane the ray leaves the present cell, and where.
  struct Exit {
    uint32_t site;
    double t, key;
  };

  bool isInTheOpen() const;
  bool skipToBall();
  void enter(CellAddress cell);
  Exit findExit();
  void stepThrough(const Exit& exit);
  bool meetCell(CellAddress cell, const QueryChunk& chunk, const glm::dvec3& centre, double exit,
                FoamSegment& segment) const;
  void clipByFace(const QueryChunk& chunk, uint32_t cell, const glm::dvec3& centre, FoamSegment& segment) const;

  const QueryFoam* foam_;
  FoamRay ray_;
  WalkLimits limits_;
  uint32_t steps_ = 0, neighbours_ = 0;
  bool hitLimit_ = false;

  CellAddress current_;
  const QueryChunk* chunk_ = nullptr;
  glm::dvec3 localOrigin_{0};  // of the ray, from the chunk's origin
  double key_ = 0, entry_ = 0;
};

}  // namespace froth
