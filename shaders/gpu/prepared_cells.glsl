// What rays find of cells without decoding them (FrothAssetInfo::prepareRays), made by prepare_cells.comp: the same
// numbers that cell_bits.glsl and foam/cell.h give. Where nothing is prepared, from the cell's bits.
//
// A chunk's quads, one array behind the other; K: detail sites of a cell
//   planes   [neighbourCount]             towards the neighbours of each row (gpu/prepared_planes.glsl)
//   faces    [liveCount * kFaceQuads]     quaternion; density, unit of the colours, widths of lobes, own axes
//   places   [liveCount * K]              place, height, red of the base colour; with heights or kPreparedRadiance
//   colours  [liveCount * K]              green, blue, lobes; with kPreparedRadiance
#ifndef FROTH_GPU_PREPARED_CELLS_GLSL
#define FROTH_GPU_PREPARED_CELLS_GLSL
#include "gpu/cell_bits.glsl"
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

// Widths of up to 32, and a bit of a word.
uint packWidths(CellHeader header) {
  return header.axis | header.lobe.x << 6 | header.lobe.y << 12 | header.ownAxes.bit << 18;
}

// As far as colours of prepared detail sites need it.
CellHeader headerOfFace(uvec2 cell) {
  Chunk chunk = loadChunk(cell.x);
  uvec4 face = chunk.prepared.v[faceQuad(chunk, cell.y) + 1];
  uvec2 lobe = uvec2(face.z >> 6 & 63u, face.z >> 12 & 63u);
  BitCursor ownAxes =
      BitCursor(FRAME.chunks.v[cell.x].cellWords, FRAME.chunks.v[cell.x].cellWordCount, face.w, face.z >> 18);
  return CellHeader(uintBitsToFloat(face.y), 0u, 0u, 0u, face.z & 63u, uvec2(0u), lobe, 0, ivec3(0), ownAxes, ownAxes);
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

// The lobes of a detail site that is seen, none if they are not wanted.
Lobes takeSeen(CellCode code, CellHeader header, uvec2 cell, uint detail, bool hasLobes, inout DetailSite site) {
  if (hasColours()) {
    Chunk chunk = loadChunk(cell.x);
    uvec4 colour = chunk.prepared.v[colourQuad(chunk, cell.y, detail)];
    site.base.g = uintBitsToFloat(colour.x);
    site.base.b = uintBitsToFloat(colour.y);
    BitCursor lobes = header.ownAxes;
    lobes.word = colour.z;
    lobes.bit = colour.w & 31u;
    return Lobes(lobes, hasLobes ? colour.w >> 5 : 0u);
  }
  if (FRAME.lobeCount == 0 || !hasLobes) return noLobes(header);
  return loadLobes(code, header, FRAME.detailCount, detail);
}

#endif
