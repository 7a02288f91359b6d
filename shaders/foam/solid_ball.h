// A ball around the solid part of a cell, smaller than the cell's own: what decides which rays can gain opacity in it.
//
// The solid part. Along a ray opacity is gained between tNear and tFar only (docs/FOAM.md "What one ray meets in one
// cell"). There the point lies in the ball, on the cell's side of each radical plane that the asset lists, and on the
// solid side of the displaced face, n . x' <= h with x' = x - p. On the way in (w = n . d < 0) that bounds tNear, on
// the way out tFar, so it holds for both sides of a face. h is a mean of the heights h_k with weights >= 0 that sum to
// one, or to less where the floor of the weight sum acts; so h <= max(h_max, 0), whatever the query point. Hence
//   solid part = {|x'| <= r} and {d_j . x' <= m_j for all neighbours j} and {n . x' <= max(h_max, 0)}.
//
// The margin. A pass computes in float, u = 2^-24, with centres relative to the eye at a distance D. Every bound of an
// interval is off by a few roundings of numbers of size D + r, and an error of t moves the point along the ray; seen
// across the bounding surface this is, with GLSL's division (2.5 ulp) and normalize (5 u):
//   ball    perpendicular 5 u D, along 4 u D, direction 6 u D, two reciprocals 10 u D          <= 25 u (D + r)
//   plane   clearance 5 u D, division and dot product 9 u t, reciprocal 5 u t, direction 6 u t <= 25 u (D + r)
//   face    numerator 4 u D, facing 4 u t, division 5 u t, direction 6 u t, height 40 u r      <= 60 u (D + r)
// So the ray that a pass sees meets the solid part with all its surfaces moved outwards by 64 u (D + r). The baker
// moves them by kSolidMargin r, 2^-8 r, and bounds *that* body, corners of sharp wedges included; it is enough while D
// <= 1023 r. Beyond, the cell's own ball serves: it is some two pixels large, and little is lost. A plane of a
// neighbour far larger than the cell is off by its own rounding too, which the baker adds. Decoding rounds by 4 u (D +
// r), less than guardedRadius() adds.
#ifndef FROTH_FOAM_SOLID_BALL_H
#define FROTH_FOAM_SOLID_BALL_H
#include "prelude.h"

// Centre and radius of a cell's solid ball. code: the bytes x, y, z, radius of ChunkContents::solidBalls as numbers
// 0..64. Far from the origin of the rays: the cell's own ball.
FOAM_FN real4 decodeSolidBall(real3 centre, real radius, real4 code) {
  real reach = real(1023) * radius;
  if (dot(centre, centre) > reach * reach) return real4(centre.x, centre.y, centre.z, radius);
  real3 offset = (real3(code.x, code.y, code.z) - real3(real(32))) * (radius / real(32));
  real3 moved = centre + offset;
  return real4(moved.x, moved.y, moved.z, radius * (code.w / real(64)));
}

#include "postlude.h"
#endif
