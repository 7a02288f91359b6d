// From cell to cell: along a ray, and down to the power cell that holds a point.
#ifndef FROTH_GPU_DESCEND_GLSL
#define FROTH_GPU_DESCEND_GLSL
#include "gpu/asset.glsl"
#if defined(FROTH_WALK)
#include "gpu/prepared_planes.glsl"
#endif
#include "foam/cell.h"

const float kLeastFall = 1e-37;
// 8 times half a unit in the last place: of the centre 2, of the products and sums 3
const float kKeyRounding = 1.0 / 2097152.0;

// The key of a step along a ray: the same bits wherever the same site is stepped to.
float keyOf(vec3 direction, vec3 centre) { return fixedDot(direction, centre); }

// What the keys of a site and of another may be off by together; its centre and that of the other as the keys have
// them.
float roundingOfKeys(vec3 centre, vec3 otherCentre) {
  vec3 sizes = abs(centre) + abs(otherCentre);
  return kKeyRounding * (sizes.x + sizes.y + sizes.z);
}

// Whether a ray may step from a cell of a chunk to another site of it. Among cells of the chunk their order decides,
// which tells apart sites that nearly coincide; a ghost lies in another place of the order of its own chunk, and is
// stepped to by a greater key alone.
bool mayStepTo(Chunk chunk, uint site, vec2 order, vec2 siteOrder, float key, float siteKey) {
  return isGhost(chunk, site) ? siteKey > key : liesFarther(order, siteOrder);
}

// Where a ray leaves a cell may be off by this much of it: 4 units of its plane's distance from the eye.
const float kExitRounding = 1.0 / 4194304.0;

// More than what the orders of two sites of such sizes are rounded by: orderAlong has 46 binary digits or more.
const float kOrderRounding = 1.0 / 17592186044416.0;

// Whether a ray that leaves a cell towards two sites, at one point but for rounding, goes on in that of the first: it
// lies less far along the ray, so that a ray may come from there to the other, and never back. (Seen from afar, the
// planes towards two sites that nearly coincide are one, however far the ray has to go from one site's cell to the
// other's.) Their difference has all digits where sites nearly coincide. Where it says less than their orders, no step
// leads from one to the other, and cell.h says which owns a ray in their plane.
bool comesBefore(vec3 direction, vec3 site, vec3 otherSite) {
  vec3 toOther = fromSiteToSite(site, otherSite);
  precise vec3 sizes = abs(site) + abs(otherSite);
  precise float rounding = kOrderRounding * (sizes.x + sizes.y + sizes.z);
  float ahead = fixedDot(direction, toOther);
  bool isTie = abs(ahead) <= rounding;
  return isTie ? comesFirst(toOther) : ahead > 0.0;
}

// Half of what a point's power falls by from one cell of a chunk to another; 0: by less than its rounding, so that no
// search goes back to a cell. As the local form of the plane between them says: powers themselves lose what sites that
// nearly coincide differ by. A point on the plane falls to the first of the two sites.
float powerFall(Chunk chunk, vec3 point, vec4 site, vec4 otherSite) {
  vec3 centre = ballOf(chunk, site).centre - point;
  vec3 toOther = fromSiteToSite(site.xyz, otherSite.xyz);
  float clearance = sharedClearance(centre, ballOf(chunk, otherSite).centre - point, toOther, site.w, otherSite.w);
  if (clearance == 0.0) return comesFirst(toOther) ? 0.0 : kLeastFall;
  return max(-exitClearance(centre, toOther, radicalOffset(toOther, site.w, otherSite.w), clearance), 0.0);
}

// The site of a part of a cell's row to which the power falls most; kNoCell: to none.
uint lowestSite(Chunk chunk, vec3 point, vec4 siteRadius, uvec2 row) {
  float most = 0.0;
  uint site = kNoCell;
  for (uint i = row.x; i < row.y; ++i) {
    uint other = neighbourAt(chunk, i);
    float fall = powerFall(chunk, point, siteRadius, siteRadiusOf(chunk, other));
    if (fall > most) {
      most = fall;
      site = other;
    }
  }
  return site;
}

uint lowestNeighbour(Chunk chunk, vec3 point, vec4 siteRadius, uvec2 row) {
#if defined(FROTH_WALK)
  if (hasPlanes()) {
    vec3 centre = ballOf(chunk, siteRadius).centre;
    uvec2 part = findFalls(chunk, row, centre - point, sizeOf(centre) + sizeOf(point));
    uint site = lowestSite(chunk, point, siteRadius, part);
    if (site != kNoCell || part.x == part.y) return site;
  }
#endif
  return lowestSite(chunk, point, siteRadius, row);
}

// The search goes where the power falls most, and ends as it falls with every step. point: relative to the eye. steps:
// how many it took. neighbours: grows by those that it tests; from FRAME.maxNeighbours on the search ends where it
// stands.
uvec2 descendTo(vec3 point, uvec2 first, out uint steps, inout uint neighbours) {
  uvec2 cell = first;
  Chunk chunk = loadChunk(cell.x);
  for (steps = 0; steps < FRAME.maxSteps && neighbours < FRAME.maxNeighbours; ++steps) {
    uvec2 row = neighbourRow(chunk, cell.y);
    neighbours += row.y - row.x;
    uint site = lowestNeighbour(chunk, point, siteRadiusOf(chunk, cell.y), row);
    if (site == kNoCell) break;
    cell = cellOfSite(chunk, site);
    if (cell.x != chunk.index) chunk = loadChunk(cell.x);
  }
  return cell;
}

uvec2 cellHolding(vec3 point, uvec2 first, inout uint neighbours) {
  uint steps;
  return descendTo(point, first, steps, neighbours);
}

#endif
