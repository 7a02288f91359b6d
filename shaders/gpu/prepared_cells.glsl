// What rays find of cells without decoding them (FrothAssetInfo::prepareRays), made by prepare_cells.comp: the same
// numbers that cell_bits.glsl and foam/cell.h give. Where nothing is prepared, from the cell's bits.
//
// A chunk's quads, one array behind the other; K: detail sites of a cell
//   planes   [neighbourCount]             towards the neighbours of each row (gpu/prepared_planes.glsl)
//   faces    [liveCount * kFaceQuads]     quaternion; density, unit of the colours
//   places   [liveCount * K]              place, height, red of the base colour; with heights or kPreparedRadiance
//   colours  [liveCount * K]              green, blue, the first of its lobes, their number; with kPreparedRadiance
//   lobes    [lobeTotal * lobeQuads]      axis and colour: one quad of codes where those of the chunk are short, else
//                                         two of floats; with kPreparedRadiance
#ifndef FROTH_GPU_PREPARED_CELLS_GLSL
#define FROTH_GPU_PREPARED_CELLS_GLSL
#include "gpu/detail_colour.glsl"
#include "gpu/prepared_planes.glsl"

bool hasColours() { return FROTH_WALK_PREPARED == kPreparedRadiance; }
bool hasPlaces() { return hasColours() || (hasPlanes() && FRAME.hasHeights != 0); }

uint faceQuad(Chunk chunk, uint cell) { return chunk.neighbourCount + kFaceQuads * checked(cell, chunk.liveCount); }

uint placeQuad(Chunk chunk, uint cell, uint detail) {
  return chunk.neighbourCount + kFaceQuads * chunk.liveCount + checked(cell, chunk.liveCount) * FRAME.detailCount + detail;
}

uint colourQuad(Chunk chunk, uint cell, uint detail) {
  return placeQuad(chunk, cell, detail) + chunk.liveCount * FRAME.detailCount;
}

// Of each lobe: 1 or 2.
uint quadsOfLobe(Chunk chunk) { return FRAME.chunks.v[chunk.index].lobeQuads; }

uint lobeQuad(Chunk chunk, uint lobe) {
  uint first = chunk.neighbourCount + chunk.liveCount * (kFaceQuads + 2 * FRAME.detailCount);
  return first + checked(lobe, FRAME.chunks.v[chunk.index].lobeTotal) * quadsOfLobe(chunk);
}

uvec4 packLobe(ivec3 axis, ivec3 colour) {
  ivec3 low = ivec3(axis.x, axis.z, colour.y), high = ivec3(axis.y, colour.x, colour.z);
  return uvec4(low & 0xffff | high << 16, 0u);
}

struct Lobe {
  vec3 axis, colour;
};

Lobe unpackLobe(CellCode code, float unit, ivec3 quad) {
  ivec3 low = quad << 16 >> 16, high = quad >> 16;
  vec3 colour = joinGreen(ivec3(high.y, low.z, high.z), code.colourStep * unit);
  return Lobe(code.axisStep * vec3(low.x, high.x, low.y), colour);
}

Lobe preparedLobe(CellCode code, float unit, Chunk chunk, uint lobe) {
  uint quad = lobeQuad(chunk, lobe);
  uvec4 first = chunk.prepared.v[quad];
  if (quadsOfLobe(chunk) == 1) return unpackLobe(code, unit, ivec3(first.xyz));
  vec4 axisRed = uintBitsToFloat(first);
  return Lobe(axisRed.xyz, vec3(axisRed.w, uintBitsToFloat(chunk.prepared.v[quad + 1].xy)));
}

struct Face {
  float density;
  Frame frame;
};

Face loadFace(CellCode code, uvec2 cell) {
  if (hasPlanes()) {
    Chunk chunk = loadChunk(cell.x);
    uint quad = faceQuad(chunk, cell.y);
    return Face(uintBitsToFloat(chunk.prepared.v[quad + 1].x), frameOf(uintBitsToFloat(chunk.prepared.v[quad])));
  }
  BitCursor bits = cellBits(cell.x, cell.y);
  float density = takeDensity(code, bits);
  return Face(density, takeFrame(code, bits));
}

// As far as prepared detail sites need it: the unit of their colours.
CellHeader headerOfFace(uvec2 cell) {
  Chunk chunk = loadChunk(cell.x);
  BitCursor none = BitCursor(FRAME.chunks.v[cell.x].cellWords, 0u, 0u, 0u);
  float unit = uintBitsToFloat(chunk.prepared.v[faceQuad(chunk, cell.y) + 1].y);
  return CellHeader(unit, 0u, 0u, 0u, 0u, uvec2(0u), uvec2(0u), 0, ivec3(0), none, none);
}

CellHeader headerForHeights(CellCode code, uvec2 cell) {
  if (hasPlaces()) return headerOfFace(cell);
  return loadCellHeader(code, cell.x, cell.y);
}

CellHeader headerForColours(CellCode code, uvec2 cell) {
  if (hasColours()) return headerOfFace(cell);
  return loadCellHeader(code, cell.x, cell.y);
}

// Place and height.
vec3 placeOfDetail(CellCode code, CellHeader header, uvec2 cell, uint detail) {
  if (hasPlaces()) {
    Chunk chunk = loadChunk(cell.x);
    return uintBitsToFloat(chunk.prepared.v[placeQuad(chunk, cell.y, detail)].xyz);
  }
  DetailSite site = loadDetailSite(code, header, FRAME.detailCount, detail);
  return vec3(site.place, site.height);
}

// For its colour: takeSeen() gives what of it a prepared site still lacks, as few sites are seen.
DetailSite loadPlacedDetail(CellCode code, CellHeader header, uvec2 cell, uint detail) {
  if (!hasColours()) return loadDetailSite(code, header, FRAME.detailCount, detail);
  Chunk chunk = loadChunk(cell.x);
  vec4 place = uintBitsToFloat(chunk.prepared.v[placeQuad(chunk, cell.y, detail)]);
  return DetailSite(place.xy, place.z, vec3(place.w, 0.0, 0.0));
}

// The lobes of a detail site that is seen, none if they are not wanted. Of a prepared site the cursor's word is the
// first of them in the chunk.
Lobes takeSeen(CellCode code, CellHeader header, uvec2 cell, uint detail, bool hasLobes, inout DetailSite site) {
  if (hasColours()) {
    Chunk chunk = loadChunk(cell.x);
    uvec4 colour = chunk.prepared.v[colourQuad(chunk, cell.y, detail)];
    site.base.g = uintBitsToFloat(colour.x);
    site.base.b = uintBitsToFloat(colour.y);
    BitCursor lobes = header.lobeCounts;
    lobes.word = colour.z;
    return Lobes(lobes, hasLobes ? colour.w : 0u);
  }
  if (FRAME.lobeCount == 0 || !hasLobes) return noLobes(header);
  return loadLobes(code, header, FRAME.detailCount, detail);
}

// The colour of what takeSeen() gave: detailColour() where the lobes are in the cell's bits.
vec3 seenColour(CellCode code, CellHeader header, uvec2 cell, Lobes lobes, vec3 base, vec3 direction) {
  if (!hasColours()) return detailColour(code, header, lobes, base, direction);
  Chunk chunk = loadChunk(cell.x);
  float weightSum = 0.0;
  vec3 colourSum = vec3(0.0);
  float largest = -3.402823466e38;
  for (uint i = 0; i < lobes.count; ++i) {
    Lobe lobe = preparedLobe(code, header.unit, chunk, lobes.cursor.word + i);
    addLobe(lobeExponent(lobe.axis, direction), lobe.colour, largest, weightSum, colourSum);
  }
  return lobeColour(base, weightSum, colourSum);
}

#endif
