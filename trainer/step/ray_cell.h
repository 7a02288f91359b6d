// One ray and one cell of a view: where the ray gains opacity in it, and the colour there (docs/FOAM.md "What one ray
// meets in one cell"). The backward pass computes a segment again and takes its branches from it.
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

#include "shaders/foam/appearance.h"
#include "shaders/foam/cell.h"
#include "shaders/foam/clip_face.h"
#include "trainer/step/seen_cells.h"

namespace froth {

// The surface that bounds a segment is the radical plane at this place among those of the cell, or one of these.
inline constexpr uint32_t kBoundedByBall = UINT32_MAX, kBoundedByEye = UINT32_MAX - 1;

template <class Real>
struct Segment {
  Real ballOrPlaneNear, ballOrPlaneFar;  // the interval that ball and planes leave
  uint32_t nearSurface, farSurface;      // of that interval
  Real facing;                           // normal . direction
  Real heightPlace;                      // where the height is asked for
  Real height, heightWeights;            // the blend there, its sum of weights
  Real face;                             // where the displaced face is met
  Real near, far;                        // what ball, planes and face leave
  glm::vec<3, Real> colour;              // at `near`
  Real colourWeights;
};

// A point of the ray in the face frame: (tangent, bitangent, normal) [radii].
template <class Real>
FROTH_HD glm::vec<3, Real> pointInFrame(const SeenCell<Real>& cell, const glm::vec<3, Real>& direction, Real t) {
  return foam::inFaceFrame(t * direction - cell.centre, cell.tangent, glm::cross(cell.normal, cell.tangent),
                           cell.normal, 1 / cell.radius);
}

// visit(i, plane): for each of a cell's planes. (Other kinds of `planes`: trainer/cuda/staged_cells.h.)
template <class Real, class Visit>
FROTH_HD void visitPlanes(const SeenPlane<Real>* planes, uint32_t count, const Visit& visit) {
  for (uint32_t i = 0; i < count; ++i) visit(i, planes[i]);
}

// Cuts the ray by ball and planes, those of the cell. Along a ray that starts at the eye a plane is met at t = 1 /
// (plane . direction) (foam::eyePlane), so the loop has no division.
template <class Real, class Planes>
FROTH_HD bool clipByBallAndPlanes(const SeenCell<Real>& cell, const Planes& planes, const glm::vec<3, Real>& direction,
                                  Segment<Real>& segment) {
  Real ballNear, ballFar;
  if (!foam::intersectBall(cell.centre, cell.radius, direction, ballNear, ballFar)) return false;
  const Real ballInverseNear = ballNear > 0 ? 1 / ballNear : Real(1e30);
  Real inverseNear = ballInverseNear, inverseFar = 1 / ballFar;
  uint32_t nearSurface = ballNear > 0 ? kBoundedByBall : kBoundedByEye, farSurface = kBoundedByBall;
  visitPlanes(planes, cell.planesEnd - cell.planesBegin, [&](uint32_t i, SeenPlane<Real> plane) {
    const Real inverse = glm::dot(plane.plane, direction);
    if (plane.clearance > 0) {
      if (inverse > inverseFar) {
        inverseFar = inverse;
        farSurface = i;
      }
    } else if (inverse < inverseNear) {
      inverseNear = inverse;
      nearSurface = i;
    }
  });
  if (!(inverseNear > inverseFar)) return false;
  segment.nearSurface = nearSurface;
  segment.farSurface = farSurface;
  segment.ballOrPlaneNear = nearSurface >= kBoundedByEye ? ballNear : 1 / inverseNear;
  segment.ballOrPlaneFar = farSurface == kBoundedByBall ? ballFar : 1 / inverseFar;
  return segment.ballOrPlaneNear < segment.ballOrPlaneFar;
}

// What `value` of the detail sites (their height, or colour) blends to at a point of the face frame [radii]; `weights`:
// the sum of their weights.
template <class Real, class Value>
FROTH_HD Value blendDetails(const SeenDetail<Real>* details, uint32_t detailCount, Value SeenDetail<Real>::*value,
                            const glm::vec<3, Real>& point, Real sharpness, Real& weights) {
  const glm::vec<3, Real> query = foam::faceQuery(point);
  Value sum(0);
  weights = 0;
  for (uint32_t k = 0; k < detailCount; ++k) {
    const SeenDetail<Real> detail = details[k];
    const Real weight = foam::detailWeight(query, detail.place, sharpness);
    sum += weight * (detail.*value);
    weights += weight;
  }
  return sum / foam::flooredWeightSum(weights);
}

// False: the ray gains no opacity in the cell, or its numbers are no finite ones. `planes`, `details`: those of the
// cell.
template <class Real, class Planes>
FROTH_HD bool meetCell(const SeenCell<Real>& cell, const Planes& planes, const SeenDetail<Real>* details,
                       uint32_t detailCount, const glm::vec<3, Real>& direction, Real sharpness,
                       Segment<Real>& segment) {
  if (!clipByBallAndPlanes(cell, planes, direction, segment)) return false;
  segment.facing = glm::dot(cell.normal, direction);
  segment.heightPlace = foam::placeOfHeight(cell.centre, cell.normal, segment.facing, segment.ballOrPlaneNear);
  segment.height = blendDetails(details, detailCount, &SeenDetail<Real>::height,
                                pointInFrame(cell, direction, segment.heightPlace), sharpness, segment.heightWeights);
  segment.face = foam::intersectFace(cell.centre, cell.normal, segment.facing, segment.height);
  segment.near = segment.ballOrPlaneNear;
  segment.far = segment.ballOrPlaneFar;
  foam::clipByFace(cell.centre, cell.normal, segment.facing, segment.height, segment.near, segment.far);
  if (!(segment.near < segment.far)) return false;
  segment.colour = blendDetails(details, detailCount, &SeenDetail<Real>::colour,
                                pointInFrame(cell, direction, segment.near), sharpness, segment.colourWeights);
  return std::isfinite(segment.colour.x + segment.colour.y + segment.colour.z + cell.density * segment.far);
}

}  // namespace froth
