// One primary ray: the cells it meets, clipped, shaded and composited (docs/FOAM.md "What one ray meets in one
// cell").
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "reference/render/view_cells.h"
#include "shaders/foam/appearance.h"
#include "shaders/foam/cell.h"
#include "shaders/foam/clip_face.h"
#include "shaders/foam/compositing.h"
#include "shaders/foam/quarters.h"

namespace froth {

// Starts at the eye plus `offset`: ViewRay in the precision of a render.
template <class Real>
struct PrimaryRay {
  glm::vec<3, Real> offset, direction;
};

// A ball that the ray meets.
template <class Real>
struct BallHit {
  uint32_t rank;  // in ViewCells::cells
  Real tNear, tFar;
};

template <class Real>
struct RayResult {
  glm::vec<3, Real> colour{0};
  glm::vec<3, Real> normal{0};
  Real logTransmittance = 0;
  Real distance = -1;
  uint32_t rank = UINT32_MAX;                    // of the cell at distance, until there of the last one that showed
  std::array<Real, 4> quarters{-1, -1, -1, -1};  // foam/quarters.h; -1: not reached
};

// What a ray sees of one cell: composited with weight T alpha, its details blended at `query` (foam::faceQuery).
template <class Real>
struct RaySegment {
  uint32_t rank;
  Real weight;
  glm::vec<3, Real> query;
};

template <class Real>
struct RaySettings {
  Real cutoff, logQuantile, sharpness;
  Real leastShare = 0;
};

// Cuts the interval by all neighbours' planes; false when nothing is left.
template <class Real>
bool clipByNeighbours(std::span<const ViewPlane<Real>> planes, const PrimaryRay<Real>& ray, BallHit<Real>& hit) {
  for (const ViewPlane<Real>& plane : planes) {
    const Real clearance = plane.clearance - glm::dot(plane.toNeighbour, ray.offset);
    foam::clipByPlane(clearance, glm::dot(plane.toNeighbour, ray.direction), foam::comesFirst(plane.toNeighbour),
                      hit.tNear, hit.tFar);
    if (!(hit.tNear < hit.tFar)) return false;
  }
  return true;
}

template <class Real>
Real blendHeight(std::span<const ViewDetail<Real>> details, const glm::vec<3, Real>& query, Real sharpness) {
  Real sum = 0, weightSum = 0;
  for (const ViewDetail<Real>& detail : details) {
    const Real weight = foam::detailWeight(query, detail.place, sharpness);
    sum += weight * detail.height;
    weightSum += weight;
  }
  return sum / foam::flooredWeightSum(weightSum);
}

template <class Real>
glm::vec<3, Real> blendColour(std::span<const ViewDetail<Real>> details, const glm::vec<3, Real>& query, Real sharpness,
                              Real leastShare) {
  glm::vec<3, Real> sum(0);
  Real weightSum = 0, shownSum = 0;
  const auto addFrom = [&](Real leastWeight, Real& weights) {
    for (const ViewDetail<Real>& detail : details) {
      const Real weight = foam::detailWeight(query, detail.place, sharpness);
      if (weight < leastWeight) continue;
      sum += weight * detail.colour;
      weights += weight;
    }
  };
  addFrom(0, weightSum);
  if (leastShare == 0 || weightSum == 0) return sum / foam::flooredWeightSum(weightSum);
  sum = glm::vec<3, Real>(0);
  addFrom(leastShare * weightSum, shownSum);
  return sum / foam::flooredWeightSum(weightSum) * (weightSum / shownSum);
}

// Where a ray gains opacity in one cell, with constant density and colour; none: tFar <= tNear.
template <class Real>
struct CellInterval {
  Real tNear = 0, tFar = 0;
  glm::vec<3, Real> query{0}, colour{0};
};

// Steps 3 to 6 for a cell whose interval the planes have cut.
template <class Real>
CellInterval<Real> shadeCell(const ViewCell<Real>& cell, std::span<const ViewDetail<Real>> details,
                             const PrimaryRay<Real>& primary, Real sharpness, BallHit<Real> hit, Real leastShare = 0) {
  const glm::vec<3, Real> centre = cell.centre - primary.offset;
  const Real facing = glm::dot(cell.frame.normal, primary.direction);
  const auto inFrame = [&](const glm::vec<3, Real>& vector) {
    return foam::inFaceFrame(vector, cell.frame.tangent, cell.frame.bitangent, cell.frame.normal, cell.inverseRadius);
  };
  const auto queryAt = [&](Real t) { return foam::faceQuery(inFrame(t * primary.direction - centre)); };
  const Real tQuery = foam::placeOfHeight(centre, cell.frame.normal, facing, hit.tNear);
  const Real height = blendHeight(details, queryAt(tQuery), sharpness);
  foam::clipByFace(centre, cell.frame.normal, facing, height, hit.tNear, hit.tFar);
  hit.tNear += cell.nearError * hit.tNear;
  hit.tFar += cell.farError * hit.tFar;
  CellInterval<Real> interval{hit.tNear, hit.tFar, {}, {}};
  if (interval.tNear < interval.tFar) {
    interval.query = queryAt(interval.tNear);
    interval.colour = blendColour(details, interval.query, sharpness, leastShare);
  }
  return interval;
}

// Step 7: an interval of constant density. Returns its weight, T alpha.
template <class Real>
Real compositeInterval(Real tNear, Real tFar, Real density, const glm::vec<3, Real>& colour,
                       const glm::vec<3, Real>& normal, Real logQuantile, RayResult<Real>& ray) {
  const Real opticalDepth = density * (tFar - tNear);
  const Real weight = std::exp(ray.logTransmittance) * foam::opacity(opticalDepth);
  const Real logAfter = ray.logTransmittance - opticalDepth;
  if (ray.logTransmittance >= logQuantile && logAfter < logQuantile) {
    ray.distance = foam::quantileDistance(tNear, ray.logTransmittance, logQuantile, density);
  }
  for (int i = 0; i < 4; ++i) {
    const Real logMiddle = std::log(foam::middleOfQuarter<Real>(i));
    if (!(ray.logTransmittance >= logMiddle && logAfter < logMiddle)) continue;
    ray.quarters[static_cast<size_t>(i)] = foam::quantileDistance(tNear, ray.logTransmittance, logMiddle, density);
  }
  ray.colour += weight * colour;
  ray.normal += weight * normal;
  ray.logTransmittance = logAfter;
  return weight;
}

// `hits` in any order; they are sorted front to back. Calls visit(segment) for every cell that shows, front to back.
template <class Real, class Visitor>
RayResult<Real> compositeHits(const ViewCells<Real>& view, const PrimaryRay<Real>& primary,
                              const RaySettings<Real>& settings, std::vector<BallHit<Real>>& hits, Visitor&& visit) {
  std::sort(hits.begin(), hits.end(), [](const BallHit<Real>& a, const BallHit<Real>& b) { return a.rank < b.rank; });
  RayResult<Real> ray;
  for (BallHit<Real>& hit : hits) {
    const ViewCell<Real>& cell = view.cells[hit.rank];
    if (!clipByNeighbours(view.planesOf(cell), primary, hit)) continue;
    const CellInterval<Real> interval =
        shadeCell(cell, view.detailsOf(hit.rank), primary, settings.sharpness, hit, settings.leastShare);
    if (!(interval.tNear < interval.tFar)) continue;
    if (ray.distance < 0) ray.rank = hit.rank;
    const Real weight = compositeInterval(interval.tNear, interval.tFar, cell.density, interval.colour,
                                          cell.frame.normal, settings.logQuantile, ray);
    visit(RaySegment<Real>{hit.rank, weight, interval.query});
    if (std::exp(ray.logTransmittance) < settings.cutoff) break;
  }
  return ray;
}

template <class Real>
RayResult<Real> compositeHits(const ViewCells<Real>& view, const PrimaryRay<Real>& primary,
                              const RaySettings<Real>& settings, std::vector<BallHit<Real>>& hits) {
  return compositeHits(view, primary, settings, hits, [](const RaySegment<Real>&) {});
}

}  // namespace froth
