// From cell to cell: along a ray, and down to the power cell that holds a point.
#ifndef FROTH_GPU_DESCEND_GLSL
#define FROTH_GPU_DESCEND_GLSL
#include "gpu/asset.glsl"
#include "foam/cell.h"

// The key of a step along a ray: the same bits wherever the same site is stepped to.
float orderAlong(vec3 direction, vec3 centre) {
  precise float key = direction.x * centre.x + direction.y * centre.y + direction.z * centre.z;
  return key;
}

// Half of what a point's power falls by from one cell of a chunk to another; 0: by less than its rounding, so that no search
// goes back to a cell. As the local form of the plane between them says: powers themselves lose what sites that nearly coincide
// differ by.
float powerFall(vec3 centre, vec4 site, vec4 otherSite) {
  vec3 toOther = fromSiteToSite(site.xyz, otherSite.xyz);
  float offset = radicalOffset(toOther, site.w, otherSite.w);
  return max(-exitClearance(centre, toOther, offset, radicalClearance(centre, toOther, offset)), 0.0);
}

// The search goes where the power falls most, and ends as it falls with every step. point: relative to the eye. steps: how many it
// took.
uvec2 descendTo(vec3 point, uvec2 first, out uint steps) {
  uvec2 cell = first;
  Chunk chunk = loadChunk(cell.x);
  for (steps = 0; steps < FRAME.maxSteps; ++steps) {
    vec4 siteRadius = siteRadiusOf(chunk, cell.y);
    vec3 centre = ballOf(chunk, siteRadius).centre - point;
    uvec2 row = neighbourRow(chunk, cell.y);
    float most = 0.0;
    uint site = kNoCell;
    for (uint i = row.x; i < row.y; ++i) {
      uint other = neighbourAt(chunk, i);
      float fall = powerFall(centre, siteRadius, siteRadiusOf(chunk, other));
      if (fall > most) {
        most = fall;
        site = other;
      }
    }
    if (site == kNoCell) break;
    cell = cellOfSite(chunk, site);
    if (cell.x != chunk.index) chunk = loadChunk(cell.x);
  }
  return cell;
}

uvec2 cellHolding(vec3 point, uvec2 first) {
  uint steps;
  return descendTo(point, first, steps);
}

#endif
