// Finds the power cell that holds the eye, or that where the middle ray of a tile of parallel rays starts: from the cell of the
// last frame, always on to the neighbour of least power. The power goes with the search into the next chunk, where it may be
// rounded otherwise: it falls with every step, so the search ends. A workgroup for each place; the threads share a cell's
// neighbours.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/descend.glsl"
#include "gpu/pixels.glsl"
#include "gpu/view_rays.glsl"

const uint kThreads = 64;
layout(local_size_x = kThreads) in;

shared float powers[kThreads];
shared uint places[kThreads];

// Place in the neighbour array of the least power, the first one among equals; its power in powers[0] of all threads.
void findLeast(Chunk chunk, uvec2 row, vec3 point) {
  uint thread = gl_LocalInvocationIndex;
  float least = kInfinity;
  uint place = kNoCell;
  for (uint i = row.x + thread; i < row.y; i += kThreads) {
    float power = powerAt(point, ballOfSite(chunk, neighbourAt(chunk, i)));
    if (power < least) {
      least = power;
      place = i;
    }
  }
  powers[thread] = least;
  places[thread] = place;
  barrier();
  for (uint stride = kThreads / 2; stride > 0; stride /= 2) {
    if (thread < stride) {
      float other = powers[thread + stride];
      if (other < powers[thread] || (other == powers[thread] && places[thread + stride] < places[thread])) {
        powers[thread] = other;
        places[thread] = places[thread + stride];
      }
    }
    barrier();
  }
}

// The last frame's cell; another asset may have fewer.
uvec2 startCell(uint place) {
  uvec2 cell = FRAME.walkStart.v[place];
  bool isThere = cell.x < FRAME.chunkCount && cell.y < FRAME.chunks.v[cell.x].cellCount;
  return isThere ? cell : uvec2(0);
}

// Relative to the eye.
vec3 startPoint() {
  if (!isParallel) return vec3(0.0);
  uvec2 middle = gl_WorkGroupID.xy * kTileSize + kTileSize / 2;
  return startOfRay(rayOf(min(middle, uvec2(FRAME.regionWidth, FRAME.regionHeight) - 1)));
}

void main() {
  uint place = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  vec3 point = startPoint();
  uvec2 cell = startCell(place);
  Chunk chunk = loadChunk(cell.x);
  float power = powerAt(point, ballOfSite(chunk, cell.y));
  for (uint steps = 0; steps < FRAME.maxSteps; ++steps) {
    findLeast(chunk, neighbourRow(chunk, cell.y), point);
    float least = powers[0];
    uint nearest = places[0];
    barrier();
    if (!(least < power)) break;
    cell = cellOfSite(chunk, neighbourAt(chunk, nearest));
    if (cell.x != chunk.index) chunk = loadChunk(cell.x);
    power = least;
  }
  if (gl_LocalInvocationIndex == 0) FRAME.walkStart.v[place] = cell;
}
