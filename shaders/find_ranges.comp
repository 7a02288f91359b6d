// Where each tile's list begins and ends among the pairs sorted by tile. Ranges of tiles without a pair stay zero.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"

layout(local_size_x = kGroupSize) in;

void main() {
  uint pair = linearGroup() * kGroupSize + gl_LocalInvocationIndex;
  uint count = COUNTERS.pairsKept;
  if (pair >= count) return;
  uint tiles = FRAME.tilesX * FRAME.tilesY;
  uint tile = checked(FRAME.sortedTiles.v[pair], tiles);
  if (pair == 0 || FRAME.sortedTiles.v[pair - 1] != tile) FRAME.tileRanges.v[tile].x = pair;
  if (pair + 1 == count || FRAME.sortedTiles.v[pair + 1] != tile) FRAME.tileRanges.v[tile].y = pair + 1;
}
