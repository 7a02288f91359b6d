// Lists the tiles by the length of their lists, longest first, in classes of a factor two: the last workgroups of the raster are
// then short ones, and no long list is left to be read alone. One workgroup. The order within a class is open; no image depends on it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"

layout(local_size_x = kGroupSize) in;

const uint kClasses = 33;

shared uint places[kClasses];  // where the next tile of a class goes

// 0: the longest.
uint classOf(uint tile) {
  uvec2 range = FRAME.tileRanges.v[tile];
  uint count = range.y - ~range.x;
  return range.y == 0 ? kClasses - 1 : 31 - findMSB(count);
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint tiles = FRAME.tilesX * FRAME.tilesY;
  if (thread < kClasses) places[thread] = 0;
  barrier();
  for (uint tile = thread; tile < tiles; tile += kGroupSize) atomicAdd(places[classOf(tile)], 1u);
  barrier();
  if (thread == 0) {
    uint place = 0;
    for (uint i = 0; i < kClasses; ++i) {
      uint count = places[i];
      places[i] = place;
      place += count;
    }
  }
  barrier();
  for (uint tile = thread; tile < tiles; tile += kGroupSize) FRAME.tileOrder.v[atomicAdd(places[classOf(tile)], 1u)] = tile;
}
