// The asset's cells. A cell is addressed as uvec2(chunk, local index). A chunk is complete in itself: the neighbours of
// its cells are sites of the same chunk, its own cells first and ghosts of cells of other chunks behind them.
//
// With levels of detail a chunk is addressed by the slot in which it lies, and outside of shaders by its number in the
// file. Ghosts name a border, and a table has the cell that is drawn there.
#ifndef FROTH_GPU_ASSET_GLSL
#define FROTH_GPU_ASSET_GLSL
#if defined(FROTH_WALK)
#include "gpu/walk_set.glsl"
#else
#include "gpu/frame.glsl"
#endif
#include "foam/solid_ball.h"

struct Ball {
  vec3 centre;  // relative to the eye
  float radius;
};

// What a pass asks of a chunk over and over, to be held in registers.
struct Chunk {
  uint index;
  vec3 offsetHigh, offsetLow;
  FloatQuadArray siteRadius;
  UintArray neighbourOffsets, neighbours;
  UintQuadArray prepared;
  uint neighbourShift;
  uint cellCount, siteCount, neighbourCount;
  uint liveCount;
};

Chunk loadChunk(uint index) {
  uint i = checked(index, FRAME.chunkCount);
  return Chunk(i, FRAME.chunks.v[i].offsetHigh.xyz, FRAME.chunks.v[i].offsetLow.xyz, FRAME.chunks.v[i].siteRadius,
               FRAME.chunks.v[i].neighbourOffsets, FRAME.chunks.v[i].neighbours, FRAME.chunks.v[i].prepared,
               FRAME.chunks.v[i].neighbourShift, FRAME.chunks.v[i].cellCount,
               FRAME.chunks.v[i].siteCount, FRAME.chunks.v[i].neighbourCount, FRAME.chunks.v[i].liveCount);
}

// The chunk whose cells the workgroups from ChunkEntry::firstGroup on have.
uint chunkOfGroup(uint group) {
  uint index = 0;
  for (uint count = FRAME.chunkCount; count > 1;) {
    uint first = count / 2;
    bool isBehind = FRAME.chunks.v[index + first].firstGroup <= group;
    index += isBehind ? first : 0;
    count = isBehind ? count - first : first;
  }
  return index;
}

// The first of its cells that this group has.
uint firstCellOfGroup(Chunk chunk, uint group) {
  return (group - FRAME.chunks.v[chunk.index].firstGroup) * kGroupSize;
}

// The site in its chunk's coordinates, and the radius.
vec4 siteRadiusOf(Chunk chunk, uint site) { return chunk.siteRadius.v[checked(site, chunk.siteCount)]; }

// (site + high) + low: exact to a unit in the last place of the result, however far the scene lies from its origin.
Ball ballOf(Chunk chunk, vec4 siteRadius) {
  precise vec3 centre = (siteRadius.xyz + chunk.offsetHigh) + chunk.offsetLow;
  return Ball(centre, siteRadius.w);
}

Ball ballOfSite(Chunk chunk, uint site) { return ballOf(chunk, siteRadiusOf(chunk, site)); }

// The bytes of a live cell's solid ball.
uint solidBallBytes(uint chunk, uint cell) {
  return FRAME.chunks.v[chunk].hasSolidBalls != 0 ? FRAME.chunks.v[chunk].solidBalls.v[cell] : kWholeBall;
}

// Rays that miss this ball gain no opacity in the cell.
Ball solidBall(Ball ball, uint bytes) {
  vec4 code = vec4(bytes & 255u, bytes >> 8 & 255u, bytes >> 16 & 255u, bytes >> 24);
  vec4 solid = decodeSolidBall(ball.centre, ball.radius, code);
  return Ball(solid.xyz, solid.w);
}

// The solid ball of an entry of FrameBlock::visibleCells.
Ball visibleBall(uvec4 cell) {
  Chunk chunk = loadChunk(cell.x);
  return solidBall(ballOfSite(chunk, cell.y), solidBallBytes(chunk.index, checked(cell.y, chunk.liveCount)));
}

// Exact where the difference of the sites is.
vec3 fromSiteToSite(vec3 site, vec3 otherSite) {
  precise vec3 difference = otherSite - site;
  return difference;
}

// Begin and end of a cell's row of neighbours.
uvec2 neighbourRow(Chunk chunk, uint cell) {
  uint local = checked(cell, chunk.cellCount);
  return uvec2(chunk.neighbourOffsets.v[local], chunk.neighbourOffsets.v[local + 1]);
}

// Of an array of elements of 32 >> shift bits.
uint elementAt(UintArray elements, uint index, uint shift) {
  uint bits = 32 >> shift;
  uint place = index & ((1u << shift) - 1);
  return elements.v[index >> shift] >> (place * bits) & (0xffffffffu >> (32 - bits));
}

// A site of the chunk.
uint neighbourAt(Chunk chunk, uint index) {
  return elementAt(chunk.neighbours, checked(index, chunk.neighbourCount), chunk.neighbourShift);
}

// Alpha-complex neighbours of a live cell.
uint alphaCountOf(Chunk chunk, uint cell) {
  UintArray counts = FRAME.chunks.v[chunk.index].alphaCounts;
  return elementAt(counts, checked(cell, chunk.liveCount), FRAME.chunks.v[chunk.index].alphaShift);
}

#if !defined(FROTH_WALK)
// Planes that a recording expands for a visible cell: of all neighbours for a walk, of those of the alpha-complex else.
uint planeCountOf(Chunk chunk, uint cell) {
  if (!isWalk()) return alphaCountOf(chunk, cell);
  uvec2 row = neighbourRow(chunk, cell);
  return row.y - row.x;
}
#endif

bool isGhost(Chunk chunk, uint site) { return site >= chunk.cellCount; }

bool hasLevels() { return FRAME.fileChunkCount != 0; }

// Whether it is a cell of a chunk that is drawn.
bool isCell(uvec2 cell) { return cell.x < FRAME.chunkCount && cell.y < FRAME.chunks.v[cell.x].cellCount; }

// Where a search begins that knows nothing better.
uvec2 firstCell() { return uvec2(FRAME.firstSlot, 0); }

// What a cell is called outside.
uvec2 namedCell(uvec2 cell) { return hasLevels() ? uvec2(FRAME.chunks.v[cell.x].number, cell.y) : cell; }

// The cell of a name, which may be any number; no cell if its chunk is not drawn.
uvec2 cellOfName(uvec2 name) {
  if (!hasLevels()) return name;
  if (name.x >= FRAME.fileChunkCount) return uvec2(kNoCell);
  uint slot = FRAME.borders.v[FRAME.borderCount + name.x];
  bool isDrawn = slot < FRAME.chunkCount && FRAME.chunks.v[slot].number == name.x;
  return isDrawn ? uvec2(slot, name.y) : uvec2(kNoCell);
}

// Where a ghost lives. The reader has checked references; a border has its cell only as far as the levels of the file
// are what they should be.
uvec2 cellOfGhost(Chunk chunk, uint site) {
  uint ghost = checked(site - chunk.cellCount, chunk.siteCount - chunk.cellCount);
  uint ref = FRAME.chunks.v[chunk.index].ghostRefs.v[ghost];
  if (hasLevels()) ref = FRAME.borders.v[checked(ref, FRAME.borderCount)];
  uvec2 cell = uvec2(ref >> FRAME.localBits, ref & ((1u << FRAME.localBits) - 1));
  if (!hasLevels() || isCell(cell)) return cell;
  checked(cell.x, 0);  // a violation
  return uvec2(chunk.index, 0);
}

// The cell that a site of the chunk is, or for which it stands as a ghost.
uvec2 cellOfSite(Chunk chunk, uint site) {
  return isGhost(chunk, site) ? cellOfGhost(chunk, site) : uvec2(chunk.index, site);
}

#if !defined(FROTH_WALK)
// The slot of a cell in the list of visible cells, or kNoCell.
uint slotOfCell(uvec2 cell) {
  uint firstWord = FRAME.chunks.v[cell.x].firstGroup * kMaskWords;
  uvec2 word = FRAME.visibility.v[checked(firstWord + cell.y / 32, FRAME.groupCount * kMaskWords)];
  uint bit = 1u << (cell.y % 32);
  return (word.x & bit) != 0 ? word.y + bitCount(word.x & (bit - 1)) : kNoCell;
}
#endif

#endif
