// The radical planes of a cell as all rays of the view see them.
#ifndef FROTH_GPU_EYE_PLANES_GLSL
#define FROTH_GPU_EYE_PLANES_GLSL
#include "gpu/asset.glsl"
#include "gpu/view_rays.glsl"
#include "foam/cell.h"

// Parallel rays meet a plane at t = (clearance - toNeighbour . start) / q, with one q for all: linear in the place
// where they start.
vec3 parallelPlane(vec3 toNeighbour, float clearance, float q, bool isFar) {
  float tiny = 1e-18 * max(abs(toNeighbour.x), max(abs(toNeighbour.y), abs(toNeighbour.z)));  // keeps the plane finite
  float guarded = abs(q) > tiny ? q : (isFar ? tiny : -tiny);
  precise vec3 plane =
      vec3(fixedDot(toNeighbour, FRAME.lensFirst.xyz), fixedDot(toNeighbour, FRAME.lensSecond.xyz), -clearance) /
      guarded;
  return plane;
}

// The plane between two sites of a chunk, given with their radii; isFar: it only lowers tFar. Always the same bits, so
// a walk may find its planes in the rows of expand_cells.comp or make them itself.
vec3 eyePlaneTo(Chunk chunk, vec4 site, vec4 otherSite, out bool isFar) {
  vec3 centre = ballOf(chunk, site).centre;
  vec3 toNeighbour = fromSiteToSite(site.xyz, otherSite.xyz);
  bool isFirst = comesFirst(toNeighbour);
  float clearance = sharedClearance(centre, ballOf(chunk, otherSite).centre, toNeighbour, site.w, otherSite.w);
  if (isParallel) {
    float q = fixedDot(toNeighbour, FRAME.forward.xyz);
    isFar = q > 0.0 || (q == 0.0 && !isFirst);  // of a plane along the rays the first cell has what lies on it too
    return parallelPlane(toNeighbour, clearance, q, isFar);
  }
  float offset = radicalOffset(toNeighbour, site.w, otherSite.w);
  if (isWalk()) clearance = exitClearance(centre, toNeighbour, offset, clearance);
  isFar = clearance > 0.0 || (clearance == 0.0 && (isFirst || isWalk()));
  return eyePlane(toNeighbour, clearance, isFar);
}

#endif
