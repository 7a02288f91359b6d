// What one ray adds to the gradients of one cell: training.md's adjoint of ray_cell.h, from what the ray shows back to
// the cell's site, radius, turn, density, detail sites, and the sums of its two bounding planes.
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

#include "shaders/foam/appearance_gradient.h"
#include "shaders/foam/cell_gradient.h"
#include "shaders/foam/clip_face_gradient.h"
#include "trainer/step/gradient_sums.h"
#include "trainer/step/ray_cell.h"

namespace froth {

// Derivatives of the loss by what a ray sees of a cell.
template <class Real>
struct SegmentSeeds {
  glm::vec<3, Real> colour;  // by the colour of the segment: T alpha dL/drgb
  Real opticalDepth;
  Real facing;  // by normal . direction, of the normal loss
};

// Without the details, which go to the sink one by one.
template <class Real>
struct SegmentGradient {
  CellSums<Real> cell;
  uint32_t planes[2] = {kBoundedByBall, kBoundedByBall};  // of the cell, whose pairs get `pairs`; others: none
  glm::vec<4, Real> pairs[2] = {glm::vec<4, Real>(0), glm::vec<4, Real>(0)};
};

// Where the point of a query moves: gradients by it, in the face frame.
template <class Real>
struct PointSums {
  glm::vec<3, Real> point{0};
  Real exponents = 0;
};

// The cell's own share of a query's gradient; returns that by t.
template <class Real>
FROTH_HD Real addPointGradient(const SeenCell<Real>& cell, const glm::vec<3, Real>& direction,
                               const glm::vec<3, Real>& point, Real sharpness, bool isFloored, PointSums<Real> sums,
                               glm::vec<3, Real>& centreInFrame, CellSums<Real>& gradient) {
  // The weights of a blend that is not floored have a common factor exp(-sharpness z^2), which cancels.
  if (isFloored) sums.point.z -= 2 * sharpness * point.z * sums.exponents;
  const Real inverseRadius = 1 / cell.radius;
  centreInFrame -= sums.point * inverseRadius;
  gradient.radius -= glm::dot(sums.point, point) * inverseRadius;
  gradient.torque += glm::cross(point, sums.point);
  return glm::dot(sums.point, foam::inFaceFrame(direction, cell.tangent, glm::cross(cell.normal, cell.tangent),
                                                cell.normal, inverseRadius));
}

template <class Real, class Sink>
FROTH_HD Real addColourGradient(const SeenCell<Real>& cell, const SeenDetail<Real>* details, uint32_t detailCount,
                                const glm::vec<3, Real>& direction, Real sharpness, const Segment<Real>& segment,
                                const glm::vec<3, Real>& seed, glm::vec<3, Real>& centreInFrame,
                                CellSums<Real>& gradient, Sink& sink) {
  const glm::vec<3, Real> point = pointInFrame(cell, direction, segment.near);
  const glm::vec<3, Real> query = foam::faceQuery(point);
  const Real inverseSum = 1 / foam::flooredWeightSum(segment.colourWeights);
  const bool isFloored = foam::flooredWeightSum(segment.colourWeights) > segment.colourWeights;
  const Real seedBlend = glm::dot(seed, segment.colour);
  PointSums<Real> sums;
  for (uint32_t k = 0; k < detailCount; ++k) {
    const SeenDetail<Real> detail = details[k];
    const Real share = foam::detailWeight(query, detail.place, sharpness) * inverseSum;
    const Real exponent = foam::exponentGradient(share, glm::dot(seed, detail.colour), seedBlend, isFloored);
    const glm::vec<2, Real> place = foam::placeGradient(point, detail.place, sharpness, exponent);
    sums.point -= glm::vec<3, Real>(place, 0);
    sums.exponents += exponent;
    sink.addColour(k, place, share * seed);
  }
  return addPointGradient(cell, direction, point, sharpness, isFloored, sums, centreInFrame, gradient);
}

template <class Real, class Sink>
FROTH_HD Real addHeightGradient(const SeenCell<Real>& cell, const SeenDetail<Real>* details, uint32_t detailCount,
                                const glm::vec<3, Real>& direction, Real sharpness, const Segment<Real>& segment,
                                Real seed, glm::vec<3, Real>& centreInFrame, CellSums<Real>& gradient, Sink& sink) {
  const glm::vec<3, Real> point = pointInFrame(cell, direction, segment.heightPlace);
  const glm::vec<3, Real> query = foam::faceQuery(point);
  const Real inverseSum = 1 / foam::flooredWeightSum(segment.heightWeights);
  const bool isFloored = foam::flooredWeightSum(segment.heightWeights) > segment.heightWeights;
  PointSums<Real> sums;
  for (uint32_t k = 0; k < detailCount; ++k) {
    const SeenDetail<Real> detail = details[k];
    const Real share = foam::detailWeight(query, detail.place, sharpness) * inverseSum;
    const Real exponent = foam::exponentGradient(share, seed * detail.height, seed * segment.height, isFloored);
    const glm::vec<2, Real> place = foam::placeGradient(point, detail.place, sharpness, exponent);
    sums.point -= glm::vec<3, Real>(place, 0);
    sums.exponents += exponent;
    sink.addHeight(k, place, share * seed);
  }
  return addPointGradient(cell, direction, point, sharpness, isFloored, sums, centreInFrame, gradient);
}

// Ball or plane at one end of the interval, met at t.
template <class Real, class Planes>
FROTH_HD void addSurfaceGradient(const SeenCell<Real>& cell, const Planes& planes, uint32_t surface,
                                 const glm::vec<3, Real>& direction, Real t, Real seed, int end,
                                 SegmentGradient<Real>& gradient) {
  const glm::vec<3, Real> local = t * direction - cell.centre;
  if (surface == kBoundedByEye || seed == 0) return;
  if (surface == kBoundedByBall) {
    foam::addBallGradient(local, cell.radius, direction, seed, gradient.cell.site, gradient.cell.radius);
    return;
  }
  gradient.planes[end] = surface;
  const SeenPlane<Real> plane = planes[surface];
  gradient.pairs[end] = foam::planeGradient(local, plane.plane * plane.clearance, direction, seed);
}

template <class Real>
FROTH_HD bool isFinite(const SegmentGradient<Real>& gradient) {
  const CellSums<Real>& cell = gradient.cell;
  Real sum = cell.radius + cell.density;
  for (int c = 0; c < 3; ++c) sum += cell.site[c] + cell.torque[c];
  for (int end = 0; end < 2; ++end) {
    const glm::vec<4, Real>& pair = gradient.pairs[end];  // 0 where there is none
    sum += pair.x + pair.y + pair.z + pair.w;
  }
  return std::isfinite(sum);
}

// The face is met where the segment begins (facing < 0) or ends, and moves by the height, which is asked for at a point
// that moves too. Returns what is left of the seed of the interval's near end.
template <class Real, class Sink>
FROTH_HD Real addFacePart(const SeenCell<Real>& cell, const SeenDetail<Real>* details, uint32_t detailCount,
                          const glm::vec<3, Real>& direction, Real sharpness, const Segment<Real>& segment, Real seed,
                          glm::vec<3, Real>& centreInFrame, CellSums<Real>& gradient, Sink& sink) {
  const Real facing = foam::boundedDivisor(segment.facing, foam::leastFacing<Real>());
  const glm::vec<3, Real> atFace = cell.radius * pointInFrame(cell, direction, segment.face);
  const Real heightSeed = foam::addFaceGradient(atFace, facing, seed, centreInFrame, gradient.torque);
  const Real placeSeed = addHeightGradient(cell, details, detailCount, direction, sharpness, segment, heightSeed,
                                           centreInFrame, gradient, sink);
  if (!(segment.facing < 0 && segment.heightPlace > segment.ballOrPlaneNear)) return placeSeed;
  const glm::vec<3, Real> atFlat = cell.radius * pointInFrame(cell, direction, segment.heightPlace);
  (void)foam::addFaceGradient(atFlat, facing, placeSeed, centreInFrame, gradient.torque);
  return 0;
}

// sink.addColour(k, place, colour) and sink.addHeight(k, place, height) get the gradients of detail site k, each once
// at most. `planes`, `details`: those of the cell. False: some number is not finite, and the caller drops what it was
// given.
template <class Real, class Planes, class Sink>
FROTH_HD bool differentiateSegment(const SeenCell<Real>& cell, const Planes& planes, const SeenDetail<Real>* details,
                                   uint32_t detailCount, const glm::vec<3, Real>& direction, Real sharpness,
                                   const Segment<Real>& segment, const SegmentSeeds<Real>& seeds,
                                   SegmentGradient<Real>& gradient, Sink& sink) {
  const Real seedSum = seeds.colour.x + seeds.colour.y + seeds.colour.z + seeds.opticalDepth + seeds.facing;
  if (!std::isfinite(seedSum)) return false;
  gradient.cell.density = (segment.far - segment.near) * seeds.opticalDepth;
  Real farSeed = cell.density * seeds.opticalDepth, nearSeed = -farSeed, faceSeed = 0;
  glm::vec<3, Real> centreInFrame(0);
  const Real colourSeed = addColourGradient(cell, details, detailCount, direction, sharpness, segment, seeds.colour,
                                            centreInFrame, gradient.cell, sink);
  if (segment.facing < 0 && segment.face > segment.ballOrPlaneNear) {
    faceSeed = nearSeed + colourSeed;
    nearSeed = 0;
  } else {
    nearSeed += colourSeed;
    if (segment.facing >= 0 && segment.face < segment.ballOrPlaneFar) {
      faceSeed = farSeed;
      farSeed = 0;
    }
  }
  if (faceSeed != 0) {
    nearSeed += addFacePart(cell, details, detailCount, direction, sharpness, segment, faceSeed, centreInFrame,
                            gradient.cell, sink);
  }
  const glm::vec<3, Real> bitangent = glm::cross(cell.normal, cell.tangent);
  gradient.cell.site = centreInFrame.x * cell.tangent + centreInFrame.y * bitangent + centreInFrame.z * cell.normal;
  gradient.cell.torque +=
      seeds.facing * foam::torqueOfNormal(glm::vec<3, Real>(glm::dot(direction, cell.tangent),
                                                            glm::dot(direction, bitangent), segment.facing));
  addSurfaceGradient(cell, planes, segment.nearSurface, direction, segment.ballOrPlaneNear, nearSeed, 0, gradient);
  addSurfaceGradient(cell, planes, segment.farSurface, direction, segment.ballOrPlaneFar, farSeed, 1, gradient);
  return isFinite(gradient);
}

}  // namespace froth
