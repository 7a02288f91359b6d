// What one ray meets in one cell: the ball, the radical planes, the displaced face.
// Source: Govindarajan et al., "Power Foam" (2026), section 3; formulas as checked in docs/FOAM.md.
//
// All positions are relative to the ray's origin: `centre` = p - o. Directions have unit length, so t is a distance
// [scene units]. Nothing here depends on where the scene lies in the world. Lengths of 1e-18 to 1e18 keep all squares
// in the floats.
//
// Cells are half-open. A ray that lies in the radical plane of two cells has equal powers to both all along; the cell
// whose site comes first, by x, then y, then z in the asset's axes, owns it. That is as if all rays were moved by an
// infinitely small step towards smaller x, a far smaller one towards smaller y and again z: so exactly one cell owns
// each point of each ray, at edges and vertices too. Each of the two cells computes their plane from the first site
// (sharedClearance), so both find the same bits, and none or both never own a ray. Where rounding moves the plane off
// the ray, the other cell may own it, but again that cell alone. (The ghosts of another chunk round by themselves:
// there alone both planes may differ by their rounding.)
#ifndef FROTH_FOAM_CELL_H
#define FROTH_FOAM_CELL_H
#include "prelude.h"

// Power of the ray's origin with respect to a cell: |p - o|^2 - r^2, the sorting key of docs/FOAM.md "Order".
FOAM_FN real powerOfOrigin(real3 centre, real radius) {
  real distance = sqrt(dot(centre, centre));
  return (distance - radius) * (distance + radius);
}

// Primary visibility skips cells near the camera as a whole (docs/FOAM.md "Near cells"). `forward` is the unit view
// axis; nearDepth <= 0 and nearRatio <= 0 switch a test off.
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

// a . b with the same bits wherever it is compiled: for dot() GPUs may fuse other products at each place.
FOAM_FN real fixedDot(real3 a, real3 b) {
  FOAM_PRECISE real sum = a.x * b.x + a.y * b.y + a.z * b.z;
  return sum;
}

// What the products of two vectors' components are rounded by. A shader's fma may round twice, so there factors are cut
// in halves of 12 digits, whose products are exact (Dekker 1971).
#if defined(__cplusplus)
FOAM_FN real3 restOfProducts(real3 a, real3 b, real3 products) {
  return real3(fma(a.x, b.x, -products.x), fma(a.y, b.y, -products.y), fma(a.z, b.z, -products.z));
}
#else
FOAM_FN real3 leadingHalf(real3 v) { return uintBitsToFloat(floatBitsToUint(v) & 0xfffff000u); }

FOAM_FN real3 restOfProducts(real3 a, real3 b, real3 products) {
  real3 aHigh = leadingHalf(a), bHigh = leadingHalf(b);
  FOAM_PRECISE real3 aLow = a - aHigh;
  FOAM_PRECISE real3 bLow = b - bHigh;
  FOAM_PRECISE real3 rest = ((aHigh * bHigh - products) + aHigh * bLow + aLow * bHigh) + aLow * bLow;
  return rest;
}
#endif

// The order of a site along a ray: direction . site as the sum of two numbers, with about twice the digits of one
// (Ogita, Rump & Oishi 2005, Dot2), as sites that nearly coincide need them. One fixed pair for a direction and a site.
FOAM_FN real2 orderAlong(real3 direction, real3 site) {
  FOAM_PRECISE real3 products = direction * site;
  real3 rests = restOfProducts(direction, site, products);
  FOAM_PRECISE real two = products.x + products.y;
  FOAM_PRECISE real ofTwo = two - products.x;
  FOAM_PRECISE real three = two + products.z;
  FOAM_PRECISE real ofThree = three - two;
  FOAM_PRECISE real rest = ((products.x - (two - ofTwo)) + (products.y - ofTwo)) +
                           ((two - (three - ofThree)) + (products.z - ofThree)) + (rests.x + rests.y + rests.z);
  FOAM_PRECISE real high = three + rest;
  FOAM_PRECISE real low = rest - (high - three);
  return real2(high, low);
}

FOAM_FN bool liesFarther(real2 order, real2 otherOrder) {
  return otherOrder.x > order.x || (otherOrder.x == order.x && otherOrder.y > order.y);
}

// Radical plane towards a neighbour, in the cell's local frame x' = x - p, toNeighbour = p_j - p_i:
// toNeighbour . x' = radicalOffset. The world-space textbook form loses every digit far from the origin.
FOAM_FN real radicalOffset(real3 toNeighbour, real radius, real neighbourRadius) {
  FOAM_PRECISE real offset =
      real(0.5) * (fixedDot(toNeighbour, toNeighbour) + (radius - neighbourRadius) * (radius + neighbourRadius));
  return offset;
}

// Signed clearance c of the ray's origin from a radical plane: the plane is met at t = c / q, q = toNeighbour .
// direction. c > 0: the origin lies on the cell's side.
FOAM_FN real radicalClearance(real3 centre, real3 toNeighbour, real offset) {
  FOAM_PRECISE real clearance = offset + fixedDot(toNeighbour, centre);
  return clearance;
}

// Whether a site comes before its neighbour, and so owns the rays in their radical plane. A neighbour in the same point
// is hidden and cuts nothing.
FOAM_FN bool comesFirst(real3 toNeighbour) {
  if (toNeighbour.x != real(0)) return toNeighbour.x > real(0);
  if (toNeighbour.y != real(0)) return toNeighbour.y > real(0);
  return toNeighbour.z >= real(0);
}

// radicalClearance, which the neighbour finds with the same bits and the other sign.
FOAM_FN real sharedClearance(real3 centre, real3 neighbourCentre, real3 toNeighbour, real radius,
                             real neighbourRadius) {
  if (comesFirst(toNeighbour)) {
    return radicalClearance(centre, toNeighbour, radicalOffset(toNeighbour, radius, neighbourRadius));
  }
  return -radicalClearance(neighbourCentre, -toNeighbour, radicalOffset(-toNeighbour, neighbourRadius, radius));
}

// Cuts [tNear, tFar] by the half-space of one radical plane. isFirst: comesFirst().
FOAM_FN void clipByPlane(real clearance, real q, bool isFirst, FOAM_INOUT(real) tNear, FOAM_INOUT(real) tFar) {
  if (q > real(0)) {
    tFar = min(tFar, clearance / q);
  } else if (q < real(0)) {
    tNear = max(tNear, clearance / q);
  } else if (clearance < real(0) || (clearance == real(0) && !isFirst)) {
    tFar = tNear;  // parallel, and on the neighbour's side
  }
}

// The same plane for all rays through one origin: s = dot(eyePlane, direction) = 1 / t. One sign of clearance only
// lowers tFar (1/tFar = max s), the other only raises tNear (1/tNear = min s; s <= 0 misses the cell), so a loop over
// planes needs no division (Olano & Greer 1997, homogeneous rasterization). isFar: which of the two, by the sign of the
// clearance; where that is 0, the first site's cell lies on the origin's side.
FOAM_FN real3 eyePlane(real3 toNeighbour, real clearance, bool isFar) {
  real longest = max(abs(toNeighbour.x), max(abs(toNeighbour.y), abs(toNeighbour.z)));
  real tiny = real(1e-30) * max(longest, real(1));  // keeps the plane finite
  real guarded = abs(clearance) > tiny ? clearance : (isFar ? tiny : -tiny);
  FOAM_PRECISE real3 plane = toNeighbour / guarded;
  return plane;
}

// A ray that runs within rounding along a plane through the origin of all rays may take either side of it, but a walk
// must find the plane as an exit: no clearance within its rounding below zero counts as negative. 4e-7: 6 and a half
// units of float, what the centre (2), a product, two sums and the last sum may err by.
FOAM_FN real exitClearance(real3 centre, real3 toNeighbour, real offset, real clearance) {
  real squared = fixedDot(toNeighbour, toNeighbour);  // the radii's part of the offset may cancel it
  // the root of the product leaves the floats beyond 4e9 units
  real lengths = sqrt(squared) * sqrt(fixedDot(centre, centre));
  FOAM_PRECISE real rounding = real(4e-7) * (lengths + squared + abs(offset));
  return clearance >= -rounding ? max(clearance, real(0)) : clearance;
}

#include "postlude.h"
#endif
