// Which tiles the instances of a recording share.
#ifndef FROTH_GPU_SHARED_TILES_GLSL
#define FROTH_GPU_SHARED_TILES_GLSL
#include "gpu/frame.glsl"

// Begin and end of a tile's list in one instance's tileCells.
uvec2 tileRange(FrameRef part, uint tile) { return part.v.tileLists.v[part.v.tileLengths.v[tile]].yz; }

// How many instances have cells there.
uint partsIn(uint tile) {
  uint count = 0;
  for (uint part = 0; part < push.partCount; ++part) {
    uvec2 range = tileRange(push.parts[part], tile);
    count += range.x < range.y ? 1 : 0;
  }
  return count;
}

#endif
