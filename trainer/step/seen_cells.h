// The cells that a view can see, prepared for its rays: front to back, relative to the eye. A cell's place in that
// order is its rank. One order serves all rays through the eye (docs/FOAM.md "Order").
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "shaders/foam/activations.h"
#include "shaders/foam/appearance.h"
#include "shaders/foam/cell.h"
#include "trainer/step/trained_cell.h"
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

// 24 bytes in float: a warp reads it as three vectors.
template <class Real>
struct alignas(2 * sizeof(Real)) SeenDetail {
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

// All but planes and details, as seen from the eye. The near tests and whether a tile meets the ball come before.
template <class Real>
FROTH_HD void prepareCell(const TrainedCell<Real>& trained, const glm::vec<3, Real>& eye, SeenCell<Real>& seen) {
  const glm::vec<4, Real> ball = trained.foam.balls[trained.cell];
  const ParameterPart<Real> raw = trained.part(Parameter::kOrientations);
  glm::vec<3, Real> bitangent;
  seen.centre = glm::vec<3, Real>(ball) - eye;
  seen.radius = ball.w;
  seen.density = foam::softplus(trained.part(Parameter::kDensity).read(0));
  foam::frameOfQuaternion(glm::vec<4, Real>(raw.readThree(0), raw.read(3)), seen.normal, seen.tangent, bitangent);
  seen.cell = trained.cell;
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

// From the eye to a detail site.
template <class Real>
FROTH_HD glm::vec<3, Real> vectorToDetail(const SeenCell<Real>& seen, const glm::vec<2, Real>& place) {
  const glm::vec<3, Real> bitangent = glm::cross(seen.normal, seen.tangent);
  return seen.centre + seen.radius * (place.x * seen.tangent + place.y * bitangent);
}

template <class Real>
FROTH_HD glm::vec<3, Real> directionOfDetail(const SeenCell<Real>& seen, const glm::vec<2, Real>& place) {
  return foam::directionToDetail(vectorToDetail(seen, place), seen.normal);
}

// Place and height of detail site k.
template <class Real>
FROTH_HD SeenDetail<Real> placeDetail(const TrainedCell<Real>& trained, const SeenCell<Real>& seen, uint32_t k) {
  const ParameterPart<Real> place = trained.part(Parameter::kDetailSites, 2 * k);
  const Real height = trained.part(Parameter::kDetailHeights).read(k);
  return {{place.read(0), place.read(1)}, seen.radius * height, glm::vec<3, Real>(0)};
}

// Detail site k with its colour as seen from the eye.
template <class Real>
FROTH_HD SeenDetail<Real> prepareDetail(const TrainedCell<Real>& trained, const SeenCell<Real>& seen, uint32_t k) {
  SeenDetail<Real> detail = placeDetail(trained, seen, k);
  const glm::vec<3, Real> direction = directionOfDetail(seen, detail.place);
  const uint32_t numbers = 3 * trained.foam.shape.lobeCount;
  const ParameterPart<Real> axes = trained.part(Parameter::kLobeAxes, k * numbers);
  const ParameterPart<Real> colours = trained.part(Parameter::kLobeColours, k * numbers);
  Real largest = Real(-1e30), weightSum = 0;
  glm::vec<3, Real> colourSum(0);
  for (uint32_t m = 0; m < numbers; m += 3) {
    const Real exponent = foam::lobeExponent(axes.readThree(m), direction);
    foam::addLobe(exponent, colours.readThree(m), largest, weightSum, colourSum);
  }
  detail.colour = foam::lobeColour(glm::vec<3, Real>(0), weightSum, colourSum);
  return detail;
}

}  // namespace froth
