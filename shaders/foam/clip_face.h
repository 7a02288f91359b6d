// Where a ray meets the displaced face of a cell, and what the face leaves of an interval in the cell (docs/FOAM.md
// "What one ray meets in one cell", steps 3 to 5). Centre, normal and heights in one frame; facing = normal .
// direction.
#ifndef FROTH_FOAM_CLIP_FACE_H
#define FROTH_FOAM_CLIP_FACE_H
#include "prelude.h"

// Parameter at which the ray meets the plane n . (x - p) = height; facing = n . direction, kept away from zero. The
// normal may have any length: the GPU's is 1 / radius. Finite, so that the point there can be asked for.
FOAM_FN real intersectFace(real3 centre, real3 normal, real facing, real height) {
  real tiny = real(1e-30);
  real farthest = real(1e30);
  real guarded = abs(facing) > tiny ? facing : (facing < real(0) ? -tiny : tiny);
  return min(max((dot(normal, centre) + height) / guarded, -farthest), farthest);
}

// Where the height of the face is asked for: where the interval begins, or behind it where the ray enters through the
// flat face.
FOAM_FN real placeOfHeight(real3 centre, real3 normal, real facing, real tNear) {
  return facing >= real(0) ? tNear : max(tNear, intersectFace(centre, normal, facing, real(0)));
}

// Cuts an interval by the face at `height`: normal . (x - p) <= height is solid.
FOAM_FN void clipByFace(real3 centre, real3 normal, real facing, real height, FOAM_INOUT(real) tNear,
                        FOAM_INOUT(real) tFar) {
  real tFace = intersectFace(centre, normal, facing, height);
  if (facing >= real(0)) {
    tFar = min(tFar, tFace);
  } else {
    tNear = max(tNear, tFace);
  }
}

#include "postlude.h"
#endif
