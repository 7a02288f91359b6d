// The asset's cells. A cell is addressed as uvec2(chunk, local index).
#ifndef FROTH_GPU_ASSET_GLSL
#define FROTH_GPU_ASSET_GLSL
#include "gpu/frame.glsl"

struct Ball {
  vec3 centre;  // relative to the eye
  float radius;
};

uvec2 cellOfRef(uint ref) {
  uint bits = FRAME.localBits;
  return bits >= 32 ? uvec2(0, ref) : uvec2(ref >> bits, ref & ((1u << bits) - 1));
}

uint checkedChunk(uint chunk) { return checked(chunk, FRAME.chunkCount); }

// The site in its chunk's coordinates, and the radius.
vec4 siteRadiusOf(uvec2 cell) {
  uint chunk = checkedChunk(cell.x);
  return FRAME.chunks.v[chunk].siteRadius.v[checked(cell.y, FRAME.chunks.v[chunk].cellCount)];
}

// (site + high) + low: exact to a unit in the last place of the result, however far the scene lies from its origin.
Ball ballOf(uint chunk, vec4 siteRadius) {
  precise vec3 centre = (siteRadius.xyz + FRAME.chunks.v[chunk].offsetHigh.xyz) + FRAME.chunks.v[chunk].offsetLow.xyz;
  return Ball(centre, siteRadius.w);
}

Ball ballOfCell(uvec2 cell) { return ballOf(checkedChunk(cell.x), siteRadiusOf(cell)); }

// From a site to another one, which may lie in another chunk. Exact where the difference of the sites is.
vec3 fromSiteToSite(uvec2 cell, vec3 site, uvec2 other, vec3 otherSite) {
  precise vec3 difference = otherSite - site;
  if (cell.x != other.x) {
    ChunkEntry from = FRAME.chunks.v[checkedChunk(cell.x)];
    ChunkEntry to = FRAME.chunks.v[checkedChunk(other.x)];
    precise vec3 high = to.offsetHigh.xyz - from.offsetHigh.xyz;
    precise vec3 low = to.offsetLow.xyz - from.offsetLow.xyz;
    difference += high + low;
  }
  return difference;
}

// Begin and end of a cell's row of neighbours.
uvec2 neighbourRow(uvec2 cell) {
  uint chunk = checkedChunk(cell.x);
  uint local = checked(cell.y, FRAME.chunks.v[chunk].cellCount);
  UintArray offsets = FRAME.chunks.v[chunk].neighbourOffsets;
  return uvec2(offsets.v[local], offsets.v[local + 1]);
}

uvec2 neighbourAt(uint chunk, uint index) {
  uint safeChunk = checkedChunk(chunk);
  return cellOfRef(FRAME.chunks.v[safeChunk].neighbours.v[checked(index, FRAME.chunks.v[safeChunk].neighbourCount)]);
}

#endif
