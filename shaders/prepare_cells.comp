// Prepares the cells of a chunk for rays (gpu/prepared_cells.glsl). A thread per cell; of more cells than a dispatch has
// threads each takes several.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#define FROTH_WALK_PREPARED FRAME.prepared
#include "gpu/prepared_cells.glsl"

layout(local_size_x = kRayGroupSize) in;

layout(buffer_reference, std430, buffer_reference_align = 16) buffer CountedChunks { ChunkEntry v[]; };

layout(push_constant) uniform Push {
  uint instance, slot;
} push;

void preparePlanes(Chunk chunk, uint cell) {
  vec4 siteRadius = siteRadiusOf(chunk, cell);
  uvec2 row = neighbourRow(chunk, cell);
  for (uint i = row.x; i < row.y; ++i) {
    vec4 other = siteRadiusOf(chunk, neighbourAt(chunk, i));
    vec3 toNeighbour = fromSiteToSite(siteRadius.xyz, other.xyz);
    chunk.prepared.v[i] = floatBitsToUint(preparePlane(toNeighbour, radicalOffset(toNeighbour, siteRadius.w, other.w)));
  }
}

void prepareFace(Chunk chunk, CellCode code, CellHeader header, uint cell) {
  BitCursor bits = cellBits(chunk.index, cell);
  float density = takeDensity(code, bits);
  uint quad = faceQuad(chunk, cell);
  chunk.prepared.v[quad] = floatBitsToUint(takeOrientation(code, bits));
  chunk.prepared.v[quad + 1] = uvec4(floatBitsToUint(vec2(density, header.unit)), 0u, 0u);
}

uint countLobes(CellHeader header) {
  BitCursor counts = header.lobeCounts;
  uint sum = 0;
  for (uint k = 0; k < FRAME.detailCount; ++k) sum += takeBits(counts, header.lobes);
  return sum;
}

// The first of so many lobes, in the order in which threads ask. No answer depends on the order.
uint placeLobes(Chunk chunk, uint count) {
  return atomicAdd(CountedChunks(FRAME.chunks).v[chunk.index].lobesPlaced, count);
}

void prepareLobe(Chunk chunk, CellCode code, CellHeader header, inout Lobes lobes, uint quad) {
  if (quadsOfLobe(chunk) == 1) {
    ivec3 axis = takeAxisCode(code, header, lobes);
    chunk.prepared.v[quad] = packLobe(axis, takeLobeColourCode(header, lobes));
    return;
  }
  vec3 axis = takeAxis(code, header, lobes);
  vec3 colour = takeLobeColour(code, header, lobes);
  chunk.prepared.v[quad] = floatBitsToUint(vec4(axis, colour.r));
  chunk.prepared.v[quad + 1] = floatBitsToUint(vec4(colour.gb, 0.0, 0.0));
}

void prepareDetails(Chunk chunk, CellCode code, CellHeader header, uint cell) {
  uint nextLobe = hasColours() ? placeLobes(chunk, countLobes(header)) : 0;
  for (uint k = 0; k < FRAME.detailCount; ++k) {
    DetailSite site = loadDetailSite(code, header, FRAME.detailCount, k);
    chunk.prepared.v[placeQuad(chunk, cell, k)] = floatBitsToUint(vec4(site.place, site.height, site.base.r));
    if (!hasColours()) continue;
    Lobes lobes = noLobes(header);
    if (FRAME.lobeCount > 0) lobes = loadLobes(code, header, FRAME.detailCount, k);
    chunk.prepared.v[colourQuad(chunk, cell, k)] = uvec4(floatBitsToUint(site.base.gb), nextLobe, lobes.count);
    for (uint i = 0; i < lobes.count; ++i, ++nextLobe) {
      prepareLobe(chunk, code, header, lobes, lobeQuad(chunk, nextLobe));
    }
  }
}

void main() {
  instanceAtHand = push.instance;
  Chunk chunk = loadChunk(push.slot);
  CellCode code = FRAME.chunks.v[push.slot].code;
  uint stride = gl_NumWorkGroups.x * kRayGroupSize;
  for (uint cell = gl_GlobalInvocationID.x; cell < chunk.cellCount; cell += stride) {
    preparePlanes(chunk, cell);
    if (cell >= chunk.liveCount) continue;
    CellHeader header = loadCellHeader(code, push.slot, cell);
    prepareFace(chunk, code, header, cell);
    if (hasPlaces()) prepareDetails(chunk, code, header, cell);
  }
}
