// How the places at which a ray meets a cell's ball and radical planes move with the cell: gradients of cell.h, for
// training. F(t, x) = 0 gives dt/dx = -F_x / F_t.
//
// `local` is the point where the ray meets the surface, relative to the cell's site; `seed` is the derivative of the
// loss by t there. Divisors are bounded, so that a grazing ray adds a large number, not infinity.
#ifndef FROTH_FOAM_CELL_GRADIENT_H
#define FROTH_FOAM_CELL_GRADIENT_H
#include "prelude.h"

// Cosines [of unit vectors] under which gradients of planes and faces are held.
FOAM_FN real leastFacing() { return real(1e-4); }

// Kept away from zero by `least` [> 0], with its sign.
FOAM_FN real boundedDivisor(real value, real least) { return value < real(0) ? min(value, -least) : max(value, least); }

// Adds the gradients of the ball's centre and radius.
FOAM_FN void addBallGradient(real3 local, real radius, real3 direction, real seed, FOAM_INOUT(real3) centreGradient,
                             FOAM_INOUT(real) radiusGradient) {
  real scaled = seed / boundedDivisor(dot(local, direction), real(1e-3) * radius);
  centreGradient = centreGradient + scaled * local;
  radiusGradient = radiusGradient + scaled * radius;
}

// What a ray adds to the sums of one directed pair: seed / q times (local, 1). q = toNeighbour . direction.
FOAM_FN real4 planeGradient(real3 local, real3 toNeighbour, real3 direction, real seed) {
  real length = sqrt(dot(toNeighbour, toNeighbour));
  real scaled = seed / boundedDivisor(dot(toNeighbour, direction), leastFacing<real>() * length);
  return real4(scaled * local.x, scaled * local.y, scaled * local.z, scaled);
}

// The gradients that such sums give the cell, and its neighbour: of the site in xyz, of the radius in w.
FOAM_FN real4 gradientOfCell(real4 sums, real radius) { return real4(sums.x, sums.y, sums.z, radius * sums.w); }

FOAM_FN real4 gradientOfNeighbour(real4 sums, real3 toNeighbour, real neighbourRadius) {
  real3 site = toNeighbour * sums.w - real3(sums.x, sums.y, sums.z);
  return real4(site.x, site.y, site.z, -neighbourRadius * sums.w);
}

// The gradient that max(r_i + r_j - |p_i - p_j|, 0)^2, counted from both sides, gives one of the pair.
FOAM_FN real4 overlapGradient(real3 toNeighbour, real radius, real neighbourRadius) {
  real distance = sqrt(dot(toNeighbour, toNeighbour));
  real overlap = max(radius + neighbourRadius - distance, real(0));
  real3 site = distance > real(0) ? toNeighbour * (real(4) * overlap / distance) : real3(real(0));
  return real4(site.x, site.y, site.z, real(4) * overlap);
}

#include "postlude.h"
#endif
