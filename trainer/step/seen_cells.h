// The cells that a view can see, prepared for its rays: front to back, relative to the eye. A cell's place in that
// order is its rank. One order serves all rays through the eye (docs/FOAM.md "Order").
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "shaders/foam/activations.h"
#include "shaders/foam/appearance.h"
#include "shaders/foam/cell.h"
#include "trainer/step/trained_foam.h"
#include "trainer/step/training_view.h"

namespace froth {

// 64 bytes in float: a warp reads it as four vectors.
template <class Real>
struct alignas(4 * sizeof(Real)) SeenCell {
  glm::vec<3, Real> centre;
  Real radius;
  glm::vec<3, Real> normal;
  Real density;
  glm::vec<3, Real> tangent;  // the bitangent is normal x tangent
  uint32_t cell;              // in the foam
  uint32_t planesBegin, planesEnd;
};

// Towards a neighbour: toNeighbour . x' = clearance, x' relative to the eye. 16 bytes in float.
template <class Real>
struct alignas(4 * sizeof(Real)) SeenPlane {
  glm::vec<3, Real> plane;  // toNeighbour / clearance (foam::eyePlane)
  Real clearance;           // kept away from 0; > 0: the eye is on the cell's side, and the plane cuts the far end
};

template <class Real>
struct SeenDetail {
  glm::vec<2, Real> place;   // (u, v) [radii]
  Real height;               // [scene units]
  glm::vec<3, Real> colour;  // as seen from the eye, display-coded
};

// Arrays by capacity. Details of rank i: [i * K, (i + 1) * K).
template <class Real>
struct SeenCells {
  static constexpr uint32_t kNotSeen = UINT32_MAX;

  uint32_t count = 0;
  SeenCell<Real>* cells;
  SeenPlane<Real>* planes;
  SeenDetail<Real>* details;
  uint32_t* rankOf;  // [foam cells] or kNotSeen
};

template <class Real>
FROTH_HD glm::vec<4, Real> ballOf(const TrainedFoam<Real>& foam, uint32_t cell) {
  const Real* point = foam.values.row(Parameter::kPoints, foam.shape, cell);
  return {point[0], point[1], point[2], foam::softplus(*foam.values.row(Parameter::kRadii, foam.shape, cell))};
}

// All but planes and details. The near tests and whether a tile meets the ball come before.
template <class Real>
FROTH_HD void prepareCell(const TrainedFoam<Real>& foam, const TrainingView<Real>& view, uint32_t cell,
                          SeenCell<Real>& seen) {
  const glm::vec<4, Real> ball = foam.balls[cell];
  const Real* quaternion = foam.values.row(Parameter::kOrientations, foam.shape, cell);
  glm::vec<3, Real> bitangent;
  seen.centre = glm::vec<3, Real>(ball) - view.eye;
  seen.radius = ball.w;
  seen.density = foam::softplus(*foam.values.row(Parameter::kDensity, foam.shape, cell));
  foam::frameOfQuaternion(glm::vec<4, Real>(quaternion[0], quaternion[1], quaternion[2], quaternion[3]), seen.normal,
                          seen.tangent, bitangent);
  seen.cell = cell;
}

// Both cells of a pair find the same plane: as seen from the one that comes first.
template <class Real>
FROTH_HD SeenPlane<Real> preparePlane(const TrainedFoam<Real>& foam, const TrainingView<Real>& view, uint32_t cell,
                                      uint32_t neighbour) {
  const glm::vec<4, Real> own = foam.balls[cell], other = foam.balls[neighbour];
  const glm::vec<3, Real> toNeighbour = glm::vec<3, Real>(other) - glm::vec<3, Real>(own);
  const Real clearance = foam::sharedClearance(glm::vec<3, Real>(own) - view.eye, glm::vec<3, Real>(other) - view.eye,
                                               toNeighbour, own.w, other.w);
  const bool isSameSite = toNeighbour == glm::vec<3, Real>(0);
  const bool isFirst = isSameSite ? cell < neighbour : foam::comesFirst(toNeighbour);
  const bool isFar = clearance > 0 || (clearance == 0 && isFirst);
  // as eyePlane keeps it away from 0
  const Real tiny = Real(1e-30);
  const Real guarded = (clearance < 0 ? -clearance : clearance) > tiny ? clearance : (isFar ? tiny : -tiny);
  return {toNeighbour / guarded, guarded};
}

// The colour of detail site k as seen from the eye, and its direction.
template <class Real>
FROTH_HD glm::vec<3, Real> directionOfDetail(const SeenCell<Real>& seen, const glm::vec<2, Real>& place) {
  const glm::vec<3, Real> bitangent = glm::cross(seen.normal, seen.tangent);
  const glm::vec<3, Real> fromEye = seen.centre + seen.radius * (place.x * seen.tangent + place.y * bitangent);
  return foam::directionToDetail(fromEye, seen.normal);
}

template <class Real>
FROTH_HD SeenDetail<Real> prepareDetail(const TrainedFoam<Real>& foam, const SeenCell<Real>& seen, uint32_t k) {
  const Real* place = foam.values.row(Parameter::kDetailSites, foam.shape, seen.cell) + 2 * k;
  SeenDetail<Real> detail;
  detail.place = {place[0], place[1]};
  detail.height = seen.radius * foam.values.row(Parameter::kDetailHeights, foam.shape, seen.cell)[k];
  const glm::vec<3, Real> direction = directionOfDetail(seen, detail.place);
  const uint32_t lobeCount = foam.shape.lobeCount;
  const Real* axes = foam.values.row(Parameter::kLobeAxes, foam.shape, seen.cell) + 3 * k * lobeCount;
  const Real* colours = foam.values.row(Parameter::kLobeColours, foam.shape, seen.cell) + 3 * k * lobeCount;
  Real largest = Real(-1e30), weightSum = 0;
  glm::vec<3, Real> colourSum(0);
  for (uint32_t m = 0; m < 3 * lobeCount; m += 3) {
    const Real exponent = foam::lobeExponent(glm::vec<3, Real>(axes[m], axes[m + 1], axes[m + 2]), direction);
    foam::addLobe(exponent, glm::vec<3, Real>(colours[m], colours[m + 1], colours[m + 2]), largest, weightSum,
                  colourSum);
  }
  detail.colour = foam::lobeColour(glm::vec<3, Real>(0), weightSum, colourSum);
  return detail;
}

}  // namespace froth
