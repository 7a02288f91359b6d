// Lists the visible cells in the order of the asset: same grid as cull_cells.comp, whose bits and scanned sums it reads.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/asset.glsl"
#include "gpu/workgroup.glsl"
#include "foam/cell.h"

layout(local_size_x = kGroupSize) in;

// Unsigned keys in the order of the floats, negative ones included.
uint orderedBits(float value) {
  uint bits = floatBitsToUint(value);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  Chunk chunk = loadChunk(gl_WorkGroupID.y);
  uint local = gl_GlobalInvocationID.x;
  uint groups = FRAME.chunkCount * FRAME.groupsPerChunk;
  uint group = checked(chunk.index * FRAME.groupsPerChunk + gl_WorkGroupID.x, groups);
  bool isLive = local < chunk.liveCount;

  uint slot = FRAME.groupSums.v[group].x;
  uint word = 0;
  for (uint i = 0; i <= thread / 32; ++i) {
    word = FRAME.visibilityMasks.v[group * kMaskWords + i];
    if (i < thread / 32) slot += bitCount(word);
  }
  slot += bitCount(word & ((1u << (thread % 32)) - 1));
  bool isVisible = (word >> (thread % 32) & 1u) != 0;

  uint planeCount = isVisible ? FRAME.chunks.v[chunk.index].alphaCounts.v[local] : 0;
  uint planeTotal;
  uint plane = FRAME.groupSums.v[group].y + scanExclusive(planeCount, planeTotal);

  if (isLive) {
    uint live = checked(chunk.liveStart + local, FRAME.visibleCapacity);
    FRAME.slotOfCell.v[live] = isVisible ? slot : kNoCell;
  }
  if (!isVisible) return;
  Ball ball = ballOfSite(chunk, local);
  slot = checked(slot, FRAME.visibleCapacity);
  FRAME.visibleCells.v[slot] = uvec4(chunk.index, local, plane, planeCount);
  FRAME.cellKeys.v[slot] = orderedBits(powerOfOrigin(ball.centre, ball.radius));
  FRAME.order.v[slot] = slot;
}
