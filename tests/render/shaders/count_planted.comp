// In place of count_tiles.comp: every cell meets FrameBlock::maxNeighbours tiles, which no pass of a raster reads.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"

layout(local_size_x = kGroupSize) in;

void main() {
  uint slot = linearGroup() * kTileCellsPerGroup + gl_LocalInvocationIndex;
  bool isCell = gl_LocalInvocationIndex < kTileCellsPerGroup && slot < COUNTERS.visibleCells;
  if (isCell) FRAME.slotTiles.v[slot] = FRAME.maxNeighbours;
}
