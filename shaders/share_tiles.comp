// Takes from every instance the tiles in which it is not alone: raster_ordered.comp and raster_merged.comp draw them. Such
// a tile is named past the last one, where no workgroup of the raster finds a pixel. A thread per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/shared_tiles.glsl"

layout(local_size_x = kGroupSize) in;

void main() {
  uint tile = gl_GlobalInvocationID.x;
  uint tiles = FRAME.tilesX * FRAME.tilesY;
  if (tile >= tiles) return;
  bool isShared = !isAlone(partsIn(tile));
  for (uint part = 0; part < push.partCount; ++part) {
    uvec2 range = tileRange(push.parts[part], tile);
    if (!isShared && range.x != range.y) continue;
    uint place = push.parts[part].v.tileLengths.v[tile];
    push.parts[part].v.tileLists.v[place].x = tiles;
  }
}
