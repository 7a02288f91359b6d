// The radical planes of a cell as all rays of the view see them.
#ifndef FROTH_GPU_EYE_PLANES_GLSL
#define FROTH_GPU_EYE_PLANES_GLSL
#include "gpu/asset.glsl"
#include "gpu/view_rays.glsl"
#include "foam/cell.h"

// Parallel rays meet a plane at t = (clearance - toNeighbour . start) / q, with one q for all: linear in the place where they start.
vec3 parallelPlane(vec3 toNeighbour, float clearance, float q) {
  float tiny = 1e-20;
  float guarded = abs(q) > tiny ? q : (q > 0.0 ? tiny : -tiny);
  precise vec3 plane =
      vec3(dot(toNeighbour, FRAME.lensFirst.xyz), dot(toNeighbour, FRAME.lensSecond.xyz), -clearance) / guarded;
  return plane;
}

// The plane between two sites of a chunk, given with their radii; isFar: it only lowers tFar. Always the same bits, so a walk
// may find its planes in the rows of expand_cells.comp or make them itself.
vec3 eyePlaneTo(Chunk chunk, vec4 site, vec4 otherSite, out bool isFar) {
  vec3 centre = ballOf(chunk, site).centre;
  vec3 toNeighbour = fromSiteToSite(site.xyz, otherSite.xyz);
  float offset = radicalOffset(toNeighbour, site.w, otherSite.w);
  float clearance = radicalClearance(centre, toNeighbour, offset);
  if (isParallel) {
    precise float q = dot(toNeighbour, FRAME.forward.xyz);
    isFar = q > 0.0;
    return parallelPlane(toNeighbour, clearance, q);
  }
  if (isWalk()) clearance = exitClearance(centre, toNeighbour, offset, clearance);
  isFar = clearance >= 0.0;
  return eyePlane(toNeighbour, clearance);
}

#endif
