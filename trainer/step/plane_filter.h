// Which radical planes of a cell no ray can end at, so that rays need not look at them. Of the balls that overlap a
// cell's, often dozens, few bound it: others' planes miss its ball, or cut off only what another plane cuts off anyway.
//
// A plane cuts the ball in a disc. Where plane k removes the whole disc of plane j, what k leaves of the ball lies on
// one side of j: on the cell's own, and j is redundant; or beyond, and the cell is empty. Planes within rounding of
// that stay. Redundant planes may be used to remove others: what removes them removes these too.
#pragma once

#include <cmath>

#include <glm/glm.hpp>

#include "shaders/foam/cell.h"
#include "trainer/step/host_device.h"

namespace froth {

// toNeighbour . x <= offset holds on the cell's side, x relative to its site.
template <class Real>
struct LocalPlane {
  glm::vec<3, Real> toNeighbour;
  Real offset;
  Real squaredLength;  // of toNeighbour
  Real rounding;       // of tests against the offset: a ten-thousandth of the radius, and what floats round off
};

// Balls: site, radius.
template <class Real>
FROTH_HD LocalPlane<Real> localPlane(const glm::vec<4, Real>& own, const glm::vec<4, Real>& other) {
  LocalPlane<Real> plane;
  plane.toNeighbour = glm::vec<3, Real>(other) - glm::vec<3, Real>(own);
  plane.offset = foam::radicalOffset(plane.toNeighbour, own.w, other.w);
  plane.squaredLength = glm::dot(plane.toNeighbour, plane.toNeighbour);
  plane.rounding = Real(1e-4) * own.w * std::sqrt(plane.squaredLength) +
                   Real(1e-6) * (plane.squaredLength + own.w * own.w + other.w * other.w);
  return plane;
}

// All of the ball lies on the cell's side: of balls that do not overlap too, and of those inside.
template <class Real>
FROTH_HD bool missesBall(const LocalPlane<Real>& plane, Real radius) {
  return plane.offset > radius * std::sqrt(plane.squaredLength) + plane.rounding;
}

// All of the ball lies beyond the plane: no ray meets the cell.
template <class Real>
FROTH_HD bool hidesBall(const LocalPlane<Real>& plane, Real radius) {
  return -plane.offset > radius * std::sqrt(plane.squaredLength) + plane.rounding;
}

// Whether `plane` is redundant, for `remover` leaves nothing of its disc and something of the ball on the cell's side.
template <class Real>
FROTH_HD bool isRemovedBy(const LocalPlane<Real>& plane, const LocalPlane<Real>& remover, Real radius) {
  if (!(plane.squaredLength > 0)) return false;
  const Real along = glm::dot(plane.toNeighbour, remover.toNeighbour) / plane.squaredLength;
  // The distance of the disc's middle beyond the remover, times its toNeighbour, as all terms below.
  const Real beyond = plane.offset * along - remover.offset - remover.rounding;
  if (!(beyond > 0)) return false;
  const Real squaredDisc = radius * radius - plane.offset * plane.offset / plane.squaredLength;
  const Real squaredAcross = remover.squaredLength - along * along * plane.squaredLength;
  if (squaredDisc > 0 && squaredAcross > 0 && !(beyond * beyond > squaredDisc * squaredAcross)) return false;
  // The ball's point that lies farthest on the cell's side of the remover.
  const Real deepest = -radius * along * plane.squaredLength / std::sqrt(remover.squaredLength);
  return deepest < plane.offset - plane.rounding;
}

}  // namespace froth
