// Finds the power cell in which a walk along the middle ray of a tile begins (gpu/walk_begin.glsl): from the cell of the
// last frame, always on to the neighbour to which the power falls most. It falls with every step, so the search ends.
// A workgroup for each tile; the threads share a cell's neighbours.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/descend.glsl"
#include "gpu/walk_begin.glsl"

const uint kThreads = 64;
layout(local_size_x = kThreads) in;

shared float falls[kThreads];
shared uint places[kThreads];

// Place in the neighbour array to which the power falls most, the first one among equals, else kNoCell; in places[0] of
// all threads.
void findMostFall(Chunk chunk, uint cell, vec3 point) {
  uint thread = gl_LocalInvocationIndex;
  vec4 siteRadius = siteRadiusOf(chunk, cell);
  uvec2 row = neighbourRow(chunk, cell);
  float most = 0.0;
  uint place = kNoCell;
  for (uint i = row.x + thread; i < row.y; i += kThreads) {
    float fall = powerFall(chunk, point, siteRadius, siteRadiusOf(chunk, neighbourAt(chunk, i)));
    if (fall > most) {
      most = fall;
      place = i;
    }
  }
  falls[thread] = most;
  places[thread] = place;
  barrier();
  for (uint stride = kThreads / 2; stride > 0; stride /= 2) {
    if (thread < stride) {
      float other = falls[thread + stride];
      if (other > falls[thread] || (other == falls[thread] && places[thread + stride] < places[thread])) {
        falls[thread] = other;
        places[thread] = places[thread + stride];
      }
    }
    barrier();
  }
}

// The last frame's cell; another asset, or other chunks that are drawn, may have fewer.
uvec2 startCell(uint tile) {
  uvec2 cell = FRAME.walkStart.v[tile];
  return isCell(cell) ? cell : firstCell();
}

void main() {
  uint tile = tileIndex(gl_WorkGroupID.xy);
  float distance;
  if (!findWalkBegin(tile, distance)) return;
  uvec2 middle = min(gl_WorkGroupID.xy * kTileSize + kTileSize / 2, uvec2(FRAME.regionWidth, FRAME.regionHeight) - 1);
  vec3 point = pointOnRay(rayOf(middle), distance);
  uvec2 cell = startCell(tile);
  Chunk chunk = loadChunk(cell.x);
  for (uint steps = 0; steps < FRAME.maxSteps; ++steps) {
    findMostFall(chunk, cell.y, point);
    uint nearest = places[0];
    barrier();
    if (nearest == kNoCell) break;
    cell = cellOfSite(chunk, neighbourAt(chunk, nearest));
    if (cell.x != chunk.index) chunk = loadChunk(cell.x);
  }
  if (gl_LocalInvocationIndex == 0) FRAME.walkStart.v[tile] = cell;
}
