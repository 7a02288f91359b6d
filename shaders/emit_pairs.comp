// Writes the (tile, visible cell) pairs in the order of the cells. Pairs beyond the capacity are lost: those of the
// farthest cells.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/tiles.glsl"
#include "gpu/workgroup.glsl"

layout(local_size_x = kGroupSize) in;

void emitPairs(uint visible, uint pair, uint end) {
  uvec4 cell = FRAME.visibleCells.v[checked(FRAME.order.v[visible], FRAME.visibleCapacity)];
  Ball ball = visibleBall(cell);
  TileBounds bounds = tileBounds(ball);
  for (int row = bounds.first.y; row <= bounds.last.y; ++row) {
    for (int column = bounds.first.x; column <= bounds.last.x; ++column) {
      if (pair >= end) return;
      if (!tileMeetsBall(ivec2(column, row), ball)) continue;
      FRAME.pairTiles.v[pair] = uint(row) * FRAME.tilesX + uint(column);
      FRAME.pairCells.v[pair] = visible;
      ++pair;
    }
  }
}

void main() {
  uint group = linearGroup();
  uint visible = group * kGroupSize + gl_LocalInvocationIndex;
  bool isCell = visible < COUNTERS.visibleCells;
  uint count = isCell ? FRAME.tileCounts.v[visible] : 0;
  uint total;
  uint before = scanExclusive(count, total);
  if (!isCell || count == 0) return;
  uint first = saturatingAdd(FRAME.groupSums.v[group].x, before);
  emitPairs(visible, first, min(saturatingAdd(first, count), FRAME.pairCapacity));
}
