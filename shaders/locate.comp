// Finds the power cell that holds the eye: from the cell of the last frame, always on to the neighbour of least power. The
// power goes with the search into the next chunk, where it may be rounded otherwise: it falls with every step, so the
// search ends. One workgroup; the threads share a cell's neighbours.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/asset.glsl"
#include "foam/cell.h"

const uint kThreads = 64;
layout(local_size_x = kThreads) in;

shared float powers[kThreads];
shared uint places[kThreads];

// Place in the neighbour array of the least power, the first one among equals; its power in powers[0] of all threads.
void findLeast(Chunk chunk, uvec2 row) {
  uint thread = gl_LocalInvocationIndex;
  float least = kInfinity;
  uint place = kNoCell;
  for (uint i = row.x + thread; i < row.y; i += kThreads) {
    Ball ball = ballOfSite(chunk, neighbourAt(chunk, i));
    float power = powerOfOrigin(ball.centre, ball.radius);
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
uvec2 startCell() {
  uvec2 cell = FRAME.walkStart.v[0];
  bool isThere = cell.x < FRAME.chunkCount && cell.y < FRAME.chunks.v[cell.x].cellCount;
  return isThere ? cell : uvec2(0);
}

void main() {
  uvec2 cell = startCell();
  Chunk chunk = loadChunk(cell.x);
  Ball ball = ballOfSite(chunk, cell.y);
  float power = powerOfOrigin(ball.centre, ball.radius);
  for (uint steps = 0; steps < FRAME.maxSteps; ++steps) {
    findLeast(chunk, neighbourRow(chunk, cell.y));
    float least = powers[0];
    uint place = places[0];
    barrier();
    if (!(least < power)) break;
    cell = cellOfSite(chunk, neighbourAt(chunk, place));
    if (cell.x != chunk.index) chunk = loadChunk(cell.x);
    power = least;
  }
  if (gl_LocalInvocationIndex == 0) FRAME.walkStart.v[0] = cell;
}
