// Which tiles the instances of a recording share.
#ifndef FROTH_GPU_SHARED_TILES_GLSL
#define FROTH_GPU_SHARED_TILES_GLSL
#include "gpu/frame.glsl"

// Begin and end of a tile's list in one instance's tileCells.
uvec2 tileRange(FrameRef part, uint tile) { return part.v.tileLists.v[part.v.tileLengths.v[tile]].yz; }

// Bits of the instances that have cells there.
uint partsIn(uint tile) {
  uint parts = 0;
  for (uint part = 0; part < push.partCount; ++part) {
    uvec2 range = tileRange(push.parts[part], tile);
    parts |= range.x < range.y ? 1u << part : 0u;
  }
  return parts;
}

// One instance draws such a tile by itself.
bool isAlone(uint parts) { return bitCount(parts) == 1; }

// raster_ordered.comp draws such a tile.
bool isInOrder(uint parts) {
  uint overlaps = 0;
  for (uint part = 0; part < push.partCount; ++part) {
    overlaps |= (parts >> part & 1) != 0 ? push.parts[part].v.overlaps & parts : 0;
  }
  return !isAlone(parts) && overlaps == 0;
}

#endif
