// Turns the sums of workgroups into sums of the workgroups before, in place; one workgroup over the whole list. Then sets
// the sizes of the passes that follow from the totals.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
#include "gpu/workgroup.glsl"

layout(local_size_x = kGroupSize) in;
layout(constant_id = kConstantDetailCount) const uint detailCount = 8;

const uint kPerThread = 8;

uvec2 addPair(uvec2 a, uvec2 b) { return uvec2(saturatingAdd(a.x, b.x), saturatingAdd(a.y, b.y)); }

uint groupsOf(uint items, uint perGroup) { return items / perGroup + (items % perGroup != 0 ? 1 : 0); }

void planVisible(uvec2 totals) {
  uint kept = min(totals.x, FRAME.visibleCapacity);
  COUNTERS.cellsWanted = totals.x;
  COUNTERS.planesWanted = totals.y;
  COUNTERS.visibleCells = kept;  // compact_cells.comp lowers it where planes lack space
  COUNTERS.visibleDispatch = dispatchOf(groupsOf(kept, kGroupSize));
  COUNTERS.expandDispatch = dispatchOf(groupsOf(kept, kGroupSize / kLanesPerCell));
  COUNTERS.siteDispatch = dispatchOf(groupsOf(kept * detailCount, kGroupSize));
  COUNTERS.cellSortDispatch = dispatchOf(groupsOf(kept, kSortKeysPerGroup));
}

void planPairs(uint total) {
  uint kept = min(total, FRAME.pairCapacity);
  COUNTERS.pairs = total;
  COUNTERS.pairsKept = kept;
  COUNTERS.pairDispatch = dispatchOf(groupsOf(kept, kGroupSize));
  COUNTERS.pairSortDispatch = dispatchOf(groupsOf(kept, kSortKeysPerGroup));
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint count = push.mode == kScanVisible ? FRAME.chunkCount * FRAME.groupsPerChunk
                                         : groupsOf(COUNTERS.visibleCells, kGroupSize);
  uvec2 carry = uvec2(0);
  for (uint round = 0; round < count; round += kGroupSize * kPerThread) {
    uint first = round + thread * kPerThread;
    uvec2 sum = uvec2(0);
    for (uint i = first; i < min(first + kPerThread, count); ++i) sum = addPair(sum, FRAME.groupSums.v[i]);
    uvec2 before, total;
    before.x = scanExclusive(sum.x, total.x);
    before.y = scanExclusive(sum.y, total.y);
    before = addPair(before, carry);
    for (uint i = first; i < min(first + kPerThread, count); ++i) {
      uvec2 value = FRAME.groupSums.v[i];
      FRAME.groupSums.v[i] = before;
      before = addPair(before, value);
    }
    carry = addPair(carry, total);
  }
  if (thread != 0) return;
  if (push.mode == kScanVisible) planVisible(carry);
  else planPairs(carry.x);
}
