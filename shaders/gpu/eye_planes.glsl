// The radical planes of a cell as all rays through the eye see them.
#ifndef FROTH_GPU_EYE_PLANES_GLSL
#define FROTH_GPU_EYE_PLANES_GLSL
#include "gpu/asset.glsl"
#include "foam/cell.h"

// The eye plane between two sites of a chunk, given with their radii; isFar: it only lowers tFar. Always the same bits, so a walk
// may find its planes in the rows of expand_cells.comp or make them itself.
vec3 eyePlaneTo(Chunk chunk, vec4 site, vec4 otherSite, out bool isFar) {
  vec3 centre = ballOf(chunk, site).centre;
  vec3 toNeighbour = fromSiteToSite(site.xyz, otherSite.xyz);
  float offset = radicalOffset(toNeighbour, site.w, otherSite.w);
  float clearance = radicalClearance(centre, toNeighbour, offset);
  if (isWalk()) clearance = exitClearance(centre, toNeighbour, offset, clearance);
  isFar = clearance >= 0.0;
  return eyePlane(toNeighbour, clearance);
}

#endif
