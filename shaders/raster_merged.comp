// Draws the tiles that several instances share whose boxes meet. Every ray reads the lists of its tile on its own: how
// far it is in one depends on what it met in the others.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_RAYS 1
#define FROTH_MERGED
#include "gpu/asset.glsl"
#include "gpu/clip_planes.glsl"
#include "gpu/pixels.glsl"
#include "gpu/shared_tiles.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

const uint kMostMisses = 8;  // cells of the list that a ray misses before it waits for the others

// In the list of a tile.
struct Cursor {
  uint entry, end;
};

bool isAtEnd(Cursor cursor, float end) { return cursor.entry >= cursor.end; }

bool meetNext(Shading shading, uvec2 pixel, float end, inout Cursor cursor, out Segment segment, out vec3 colour,
              out uint slot, out CellRecord cell) {
  vec3 ray = rayOf(pixel);
  Segment segments[kRays];
  bool isMet = false;
  for (uint i = 0; i < kMostMisses && cursor.entry < cursor.end && !isMet; ++i) {
    slot = checked(FRAME.tileCells.v[checked(cursor.entry, FRAME.pairCapacity)], FRAME.visibleCapacity);
    isMet = meetBall(shading.records.v[slot].ball, ray, segments[0].tNear, segments[0].tFar);
    ++cursor.entry;
  }
  if (!isMet) return false;
  cell = shading.records.v[slot];
  countWork(kWorkBallHits, 1);
  segments[0].tFar = min(segments[0].tFar, end);
  vec3 colours[kRays];
  uvec3 row = uvec3(cell.planeBegin, cell.planeSplit, cell.planeEnd);
  if (isEmpty(segments[0]) || !clipByPlanes(shading, row, vec3[](ray), segments)) return false;
  bool isShown = shadeSegments(shading, slot, cell, vec3[](ray), segments, colours);
  segment = segments[0];
  colour = colours[0];
  return isShown;
}

#include "gpu/streams.glsl"

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  selectPart(0);
  uvec2 tileAt = pixel / kTileSize;
  uint tile = tileAt.y * FRAME.tilesX + tileAt.x;
  uint parts = partsIn(tile);
  if (!isInRegion(pixel) || isAlone(parts) || isInOrder(parts)) return;
  findRayEnd(pixel);
  streamCount = 0;
  if (!seesNothing(rayOf(pixel))) {
    for (uint part = 0; part < push.partCount; ++part) {
      uvec2 range = tileRange(push.parts[part], tile);
      selectPart(part);
      if (range.x < range.y) startStream(part, rayOf(pixel), Cursor(range.x, range.y));
    }
  }
  writeMerged(pixel, mergeStreams(pixel));
}
