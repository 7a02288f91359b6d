// Balls against bundles of rays through one origin: what decides which cells a view, a tile or a few pixels can meet.
//
// A rectangle of rays is the set corner + s edgeX + t edgeY, 0 <= s, t <= 1 (directions need no unit length; the three
// vectors must be linearly independent). Ball centres are relative to the origin of the rays.
#ifndef FROTH_FOAM_RAYS_H
#define FROTH_FOAM_RAYS_H
#include "prelude.h"

// Rounding must never lose a ball: radius plus a few units in the last place of the centre's distance, in float.
FOAM_FN real guardedRadius(real3 centre, real radius) {
  return radius * real(1.0001) + real(2e-6) * sqrt(dot(centre, centre));
}

// Whether the ray along `direction` meets the ball. The eye lies outside.
FOAM_FN bool rayMeetsBall(real3 centre, real radius, real3 direction) {
  real3 moment = cross(centre, direction);
  return dot(centre, direction) > real(0) && dot(moment, moment) <= radius * radius * dot(direction, direction);
}

// Whether a ray start + s edge, 0 <= s <= 1, meets the ball: the ray nearest to the centre decides. Where the
// stationary point of the angle is a maximum, an end is nearest.
FOAM_FN bool edgeMeetsBall(real3 centre, real radius, real3 start, real3 edge) {
  real startStart = dot(start, start);
  real startEdge = dot(start, edge);
  real centreStart = dot(centre, start);
  real centreEdge = dot(centre, edge);
  real numerator = centreEdge * startStart - centreStart * startEdge;
  real denominator = centreStart * dot(edge, edge) - centreEdge * startEdge;
  if (denominator > real(0)) {
    real s = min(max(numerator / denominator, real(0)), real(1));
    return rayMeetsBall(centre, radius, start + edge * s);
  }
  return rayMeetsBall(centre, radius, start) || rayMeetsBall(centre, radius, start + edge);
}

// Whether any ray of the rectangle meets the ball; true for balls that hold the origin. Exact up to a guard that only
// adds. The ball's image is convex. If the centre has an image, it is part of that, so a ball that meets the rectangle
// meets the centre or one of the at most two edges that face it.
FOAM_FN bool rectangleMeetsBall(real3 centre, real exactRadius, real3 corner, real3 edgeX, real3 edgeY) {
  real radius = guardedRadius(centre, exactRadius);
  if (dot(centre, centre) <= radius * radius) return true;
  // centre = w (corner + s edgeX + t edgeY), by Cramer's rule.
  real3 normal = cross(edgeX, edgeY);
  real determinant = dot(corner, normal);
  real w = dot(centre, normal) / determinant;
  real ws = dot(centre, cross(edgeY, corner)) / determinant;
  real wt = dot(centre, cross(corner, edgeX)) / determinant;
  if (w > real(0) && ws >= real(0) && ws <= w && wt >= real(0) && wt <= w) return true;
  bool isBehind = !(w > real(0));
  real3 alongX = wt > w ? corner + edgeY : corner;
  real3 alongY = ws > w ? corner + edgeX : corner;
  if ((isBehind || wt < real(0) || wt > w) && edgeMeetsBall(centre, radius, alongX, edgeX)) return true;
  if ((isBehind || ws < real(0) || ws > w) && edgeMeetsBall(centre, radius, alongY, edgeY)) return true;
  if (!isBehind) return false;
  alongX = wt > w ? corner : corner + edgeY;
  alongY = ws > w ? corner : corner + edgeX;
  return edgeMeetsBall(centre, radius, alongX, edgeX) || edgeMeetsBall(centre, radius, alongY, edgeY);
}

// Interval of x in which planes through the origin with normal n0 + x n1 cut the ball; a ball's image lies between its
// ends. Returns false if there is no bound: the ball holds the origin or crosses the plane with normal n1.
FOAM_FN bool boundBallImage(real3 exactCentre, real exactRadius, real3 n0, real3 n1, FOAM_OUT(real) low,
                            FOAM_OUT(real) high) {
  // At distance 1: fourth powers of lengths and lenses meet below, and leave the floats in units of 1e-6.
  real inverseDistance = real(1) / max(sqrt(dot(exactCentre, exactCentre)), real(1e-30));
  real3 centre = exactCentre * inverseDistance;
  real radius = guardedRadius(exactCentre, exactRadius) * inverseDistance;
  real c0 = dot(n0, centre);
  real c1 = dot(n1, centre);
  real squaredRadius = radius * radius;
  real n01 = dot(n0, n1);
  real n11 = dot(n1, n1);
  real quadratic = c1 * c1 - squaredRadius * n11;
  low = real(0);
  high = real(0);
  if (!(quadratic > real(0))) return false;
  // The discriminant of (c0 + x c1)^2 = r^2 |n0 + x n1|^2 over r^2, written without the cancellation of b^2 - ac.
  real3 mixed = c1 * n0 - c0 * n1;
  real discriminant = dot(mixed, mixed) - squaredRadius * (dot(n0, n0) * n11 - n01 * n01);
  if (!(discriminant >= real(0))) return false;
  real middle = squaredRadius * n01 - c0 * c1;
  real halfWidth = radius * sqrt(discriminant);
  low = (middle - halfWidth) / quadratic;
  high = (middle + halfWidth) / quadratic;
  return true;
}

#include "postlude.h"
#endif
