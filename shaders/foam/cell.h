// What one ray meets in one cell: the ball, the radical planes, the displaced face.
// Source: Govindarajan et al., "Power Foam" (2026), section 3; formulas as checked in the design's foam.md.
//
// All positions are relative to the ray's origin: `centre` = p - o. Directions have unit length, so t is a distance
// [scene units]. Nothing here depends on where the scene lies in the world.
#ifndef FROTH_FOAM_CELL_H
#define FROTH_FOAM_CELL_H
#include "prelude.h"

// Power of the ray's origin with respect to a cell: |p - o|^2 - r^2, the sorting key of foam.md "Order".
FOAM_FN real powerOfOrigin(real3 centre, real radius) {
  real distance = sqrt(dot(centre, centre));
  return (distance - radius) * (distance + radius);
}

// Primary visibility skips cells near the camera as a whole (foam.md "Near cells"). `forward` is the unit view axis;
// nearDepth <= 0 and nearRatio <= 0 switch a test off.
FOAM_FN bool isNearCell(real3 centre, real radius, real3 forward, real nearRatio, real nearDepth) {
  if (nearRatio > real(0) && dot(centre, centre) < nearRatio * nearRatio * radius * radius) return true;
  return nearDepth > real(0) && dot(forward, centre) < nearDepth;
}

// Interval of the ray inside the ball, from the perpendicular distance (b^2 - 4ac loses small, far balls).
// Returns whether there is one; tNear >= 0.
FOAM_FN bool intersectBall(real3 centre, real radius, real3 direction, FOAM_OUT(real) tNear, FOAM_OUT(real) tFar) {
  real along = dot(centre, direction);
  real3 perpendicular = centre - along * direction;
  real halfChordSquared = radius * radius - dot(perpendicular, perpendicular);
  real halfChord = sqrt(max(halfChordSquared, real(0)));
  tNear = max(along - halfChord, real(0));
  tFar = along + halfChord;
  return halfChordSquared > real(0) && tFar > tNear;
}

// Radical plane towards a neighbour, in the cell's local frame x' = x - p, toNeighbour = p_j - p_i:
// toNeighbour . x' = radicalOffset. The world-space textbook form loses every digit far from the origin.
FOAM_FN real radicalOffset(real3 toNeighbour, real radius, real neighbourRadius) {
  FOAM_PRECISE real offset =
      real(0.5) * (dot(toNeighbour, toNeighbour) + (radius - neighbourRadius) * (radius + neighbourRadius));
  return offset;
}

// Signed clearance c of the ray's origin from a radical plane: the plane is met at t = c / q, q = toNeighbour . direction.
// c > 0: the origin lies on the cell's side.
FOAM_FN real radicalClearance(real3 centre, real3 toNeighbour, real offset) {
  FOAM_PRECISE real clearance = offset + dot(toNeighbour, centre);
  return clearance;
}

// Cuts [tNear, tFar] by the half-space of one radical plane.
FOAM_FN void clipByPlane(real clearance, real q, FOAM_INOUT(real) tNear, FOAM_INOUT(real) tFar) {
  if (q > real(0)) {
    tFar = min(tFar, clearance / q);
  } else if (q < real(0)) {
    tNear = max(tNear, clearance / q);
  } else if (clearance < real(0)) {
    tFar = tNear;  // parallel, and on the neighbour's side
  }
}

// The same plane for all rays through one origin: s = dot(eyePlane, direction) = 1 / t. One sign of clearance only
// lowers tFar (1/tFar = max s), the other only raises tNear (1/tNear = min s; s <= 0 misses the cell), so a loop over
// planes needs no division (Olano & Greer 1997, homogeneous rasterization).
FOAM_FN real3 eyePlane(real3 toNeighbour, real clearance) {
  real tiny = real(1e-30);
  real guarded = abs(clearance) > tiny ? clearance : (clearance < real(0) ? -tiny : tiny);
  FOAM_PRECISE real3 plane = toNeighbour / guarded;
  return plane;
}

// A ray that runs within rounding along a plane through the origin of all rays may take either side of it, but a walk must find
// the plane as an exit: no clearance within its rounding below zero counts as negative.
FOAM_FN real exitClearance(real3 centre, real3 toNeighbour, real offset, real clearance) {
  real squared = dot(toNeighbour, toNeighbour);  // the radii's part of the offset may cancel it
  real lengths = sqrt(squared) * sqrt(dot(centre, centre));  // the root of the product leaves the floats beyond 4e9 units
  FOAM_PRECISE real rounding = real(1e-6) * (lengths + squared + abs(offset));
  return clearance >= -rounding ? max(clearance, real(0)) : clearance;
}

// Parameter at which the ray meets the plane n . (x - p) = height; facing = n . direction, kept away from zero.
FOAM_FN real intersectFace(real3 centre, real3 normal, real facing, real height) {
  real tiny = real(1e-12);
  real guarded = abs(facing) > tiny ? facing : (facing < real(0) ? -tiny : tiny);
  return (dot(normal, centre) + height) / guarded;
}

#include "postlude.h"
#endif
