// How many tiles each visible cell's solid ball meets, and the sum of each workgroup. A thread per visible cell, nearest first.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/tiles.glsl"
#include "gpu/workgroup.glsl"

layout(local_size_x = kGroupSize) in;

uint countTiles(uint visible) {
  uvec4 cell = FRAME.visibleCells.v[checked(FRAME.order.v[visible], FRAME.visibleCapacity)];
  Ball ball = visibleBall(cell);
  TileBounds bounds = tileBounds(ball);
  uint count = 0;
  for (int row = bounds.first.y; row <= bounds.last.y; ++row) {
    for (int column = bounds.first.x; column <= bounds.last.x; ++column) {
      if (tileMeetsBall(ivec2(column, row), ball)) ++count;
    }
  }
  return count;
}

void main() {
  uint group = linearGroup();
  uint visible = group * kGroupSize + gl_LocalInvocationIndex;
  uint count = 0;
  if (visible < COUNTERS.visibleCells) {
    count = countTiles(visible);
    FRAME.tileCounts.v[visible] = count;
  }
  uint total;
  scanExclusive(count, total);
  if (gl_LocalInvocationIndex == 0 && group * kGroupSize < COUNTERS.visibleCells) FRAME.groupSums.v[group] = uvec2(total, 0);
}
