// Lists the visible cells in the order of the asset: same grid as cull_cells.comp, whose bits and scanned sums it reads.
// Cells that find no space are no longer visible: all from the first one on for whom there is no slot or no planes. A walk
// does without planes that find no space.
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

// Slots that the cells before this thread's take; `word` gets its 32 cells' bits, and its first slot is stored.
uint slotOfThread(uint group, out uint word) {
  uint thread = gl_LocalInvocationIndex;
  uint firstWord = group * kMaskWords;
  uint slot = FRAME.groupSums.v[group].x;
  for (uint i = 0; i < thread / 32; ++i) slot += bitCount(FRAME.visibility.v[firstWord + i].x);
  word = FRAME.visibility.v[firstWord + thread / 32].x;
  if (thread % 32 == 0) FRAME.visibility.v[firstWord + thread / 32].y = slot;
  return slot + bitCount(word & ((1u << (thread % 32)) - 1));
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  Chunk chunk = loadChunk(gl_WorkGroupID.y);
  uint local = gl_GlobalInvocationID.x;
  uint group = checked(chunk.index * FRAME.groupsPerChunk + gl_WorkGroupID.x, FRAME.chunkCount * FRAME.groupsPerChunk);

  uint word;
  uint slot = slotOfThread(group, word);
  bool isVisible = (word >> (thread % 32) & 1u) != 0;
  uint planeCount = isVisible ? planeCountOf(chunk, local) : 0;
  uint planeTotal;
  uint plane = saturatingAdd(FRAME.groupSums.v[group].y, scanExclusive(planeCount, planeTotal));
  if (!isVisible) return;

  bool hasPlanes = saturatingAdd(plane, planeCount) <= FRAME.planeCapacity;
  if (slot >= FRAME.visibleCapacity || (!hasPlanes && (FRAME.flags & kFlagWalk) == 0)) {
    atomicMin(COUNTERS.visibleCells, slot);
    atomicAnd(FRAME.visibility.v[group * kMaskWords + thread / 32].x, ~(1u << (thread % 32)));
    return;
  }
  Ball ball = ballOfSite(chunk, local);
  FRAME.visibleCells.v[slot] = uvec4(chunk.index, local, plane, hasPlanes ? planeCount : 0);
  FRAME.cellKeys.v[slot] = orderedBits(powerOfOrigin(ball.centre, ball.radius));
  FRAME.order.v[slot] = slot;
}
