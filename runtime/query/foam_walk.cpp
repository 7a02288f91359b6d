#include "runtime/query/foam_walk.h"

#include <algorithm>
#include <limits>

#include "shaders/foam/appearance.h"
#include "shaders/foam/cell.h"
#include "shaders/foam/clip_face.h"
#include "shaders/foam/next_cell.h"

namespace froth {
namespace {

constexpr uint32_t kNoSite = UINT32_MAX;

// Blended height of the face at a query point in its frame [scene units].
double heightAt(const QueryDetail* details, uint32_t count, const glm::dvec3& query, double sharpness, double radius) {
  double sum = 0, weightSum = 0;
  for (uint32_t k = 0; k < count; ++k) {
    const double weight = foam::detailWeight(query, glm::dvec2(details[k].place), sharpness);
    sum += weight * details[k].height;
    weightSum += weight;
  }
  return radius * sum / foam::flooredWeightSum(weightSum);
}

}  // namespace

FoamWalk::FoamWalk(const QueryFoam& foam, const FoamRay& ray, const WalkLimits& limits)
    : foam_(&foam), ray_(ray), limits_(limits), current_(foam.findEntry(ray.origin)) {
  const bool isAtCell = foam.approach(current_, ray.origin);
  enter(current_);
  if (isAtCell) return;
  key_ = -std::numeric_limits<double>::infinity();
  skipToBall();
}

void FoamWalk::enter(CellAddress cell) {
  current_ = cell;
  chunk_ = &foam_->chunk(cell.chunk);
  localOrigin_ = ray_.origin - chunk_->origin;
  key_ = glm::dot(ray_.direction, chunk_->siteOf(cell.cell) - localOrigin_);
}

bool FoamWalk::next(FoamSegment& segment) {
  while (entry_ < ray_.tEnd) {
    if (steps_ == limits_.steps || neighbours_ >= limits_.neighbours) {
      hitLimit_ = true;
      return false;
    }
    if (isInTheOpen() && skipToBall()) continue;
    ++steps_;
    const Exit exit = findExit();
    const CellAddress cell = current_;
    const QueryChunk& chunk = *chunk_;
    const glm::dvec3 centre = chunk.siteOf(cell.cell) - localOrigin_;
    const bool isMet = meetCell(cell, chunk, centre, std::min(exit.t, ray_.tEnd), segment);
    stepThrough(exit);
    if (isMet) return true;
  }
  return false;
}

// The present cell has a long row, and its ball lies behind or aside.
bool FoamWalk::isInTheOpen() const {
  if (!foam_->isRowLong(*chunk_, current_.cell)) return false;
  if (current_.cell >= chunk_->liveCount) return true;
  double tNear, tFar;
  const glm::dvec3 centre = chunk_->siteOf(current_.cell) - localOrigin_;
  return !foam::intersectBall(centre, chunk_->radiusOf(current_.cell), ray_.direction, tNear, tFar) || tFar <= entry_;
}

// Only forwards, as a step: where rounding sees it otherwise, the walk goes on through the present cell.
bool FoamWalk::skipToBall() {
  const BallEntry ball = foam_->findFirstBall(ray_.origin, ray_.direction, entry_, ray_.tEnd);
  neighbours_ += ball.asked;
  if (!(ball.t < ray_.tEnd)) {
    entry_ = ray_.tEnd;
    return true;
  }
  const double before = key_;
  const CellAddress from = current_;
  enter(foam_->locateFrom(ball.cell, ray_.origin + ball.t * ray_.direction));
  if (key_ > before) {
    entry_ = ball.t;
    return true;
  }
  enter(from);
  key_ = before;
  return false;
}

FoamWalk::Exit FoamWalk::findExit() {
  const glm::dvec3 site = chunk_->siteOf(current_.cell);
  const glm::dvec3 centre = site - localOrigin_;
  const double radius = chunk_->radiusOf(current_.cell);
  Exit exit{kNoSite, std::numeric_limits<double>::infinity(), key_};
  double clearance = 1, q = 0;  // of the nearest plane
  const uint32_t begin = chunk_->neighbourOffsets[current_.cell], end = chunk_->neighbourOffsets[current_.cell + 1];
  neighbours_ += end - begin;
  for (uint32_t i = begin; i < end; ++i) {
    const uint32_t other = chunk_->neighbourAt(i);
    const glm::dvec3 toNeighbour = chunk_->siteOf(other) - site;
    const double otherQ = glm::dot(ray_.direction, toNeighbour);
    const double offset = foam::radicalOffset(toNeighbour, radius, chunk_->radiusOf(other));
    const double otherClearance = foam::radicalClearance(centre, toNeighbour, offset);
    const double lead = foam::exitLead(otherClearance, otherQ, clearance, q);
    if (!((otherQ > 0) & (lead >= 0))) continue;  // one branch, seldom taken: half of the neighbours lie ahead
    // Towards two sites at one point: the first owns a ray in their plane (shaders/foam/cell.h).
    if (lead == 0 && !(exit.site != kNoSite && foam::comesFirst(chunk_->siteOf(exit.site) - chunk_->siteOf(other)))) {
      continue;
    }
    const double key = glm::dot(ray_.direction, chunk_->siteOf(other) - localOrigin_);
    if (!(key > key_)) continue;
    exit.site = other;
    exit.key = key;
    clearance = otherClearance;
    q = otherQ;
  }
  if (exit.site != kNoSite) exit.t = clearance / q;
  exit.t = std::max(exit.t, entry_);
  return exit;
}

void FoamWalk::stepThrough(const Exit& exit) {
  entry_ = exit.t;
  if (exit.site == kNoSite) return;  // to infinity
  key_ = exit.key;
  const uint32_t from = current_.chunk;
  current_ = foam_->cellOfSite(current_, exit.site);
  if (current_.chunk == from) return;
  chunk_ = &foam_->chunk(current_.chunk);
  localOrigin_ = ray_.origin - chunk_->origin;
}

// Steps 1 to 5 of docs/FOAM.md "What one ray meets in one cell"; the walk has cut the interval by the planes.
bool FoamWalk::meetCell(CellAddress cell, const QueryChunk& chunk, const glm::dvec3& centre, double exit,
                        FoamSegment& segment) const {
  segment.density = chunk.densityOf(cell.cell);
  segment.cell = cell;
  if (!(segment.density > 0)) return false;
  if (!foam::intersectBall(centre, chunk.radiusOf(cell.cell), ray_.direction, segment.tNear, segment.tFar)) {
    return false;
  }
  segment.tNear = std::max(segment.tNear, entry_);
  segment.tFar = std::min(segment.tFar, exit);
  if (!(segment.tNear < segment.tFar)) return false;
  clipByFace(chunk, cell.cell, centre, segment);
  return segment.tNear < segment.tFar;
}

void FoamWalk::clipByFace(const QueryChunk& chunk, uint32_t cell, const glm::dvec3& centre,
                          FoamSegment& segment) const {
  const glm::dmat3 frame = chunk.faceFrameOf(cell);
  const double facing = glm::dot(frame[0], ray_.direction);
  double height = 0;
  if (!chunk.details.empty()) {
    const double radius = chunk.radiusOf(cell);
    const double tQuery = foam::placeOfHeight(centre, frame[0], facing, segment.tNear);
    const glm::dvec3 local =
        foam::inFaceFrame(tQuery * ray_.direction - centre, frame[1], frame[2], frame[0], 1 / radius);
    const uint32_t count = foam_->detailCount();
    height =
        heightAt(&chunk.details[size_t{cell} * count], count, foam::faceQuery(local), foam_->detailSharpness(), radius);
  }
  foam::clipByFace(centre, frame[0], facing, height, segment.tNear, segment.tFar);
}

}  // namespace froth
