// Lists the visible cells in the order of the asset, and plans the passes over them: same grid as cull_cells.comp,
// whose bits and sums it reads. Where even the cells of one size key find no space, or a driver rounds sizes apart, all
// from the first one on for whom there is no slot or no planes are no longer visible. A walk does without planes that
// find no space.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/asset.glsl"
#include "gpu/histogram.glsl"
#define FROTH_SCANNED uvec3
#include "gpu/workgroup.glsl"
#include "foam/cell.h"

layout(local_size_x = kGroupSize) in;
layout(constant_id = kConstantDetailCount) const uint detailCount = 8;

shared uint lostSlot;  // of the first cell that finds no space

// The power of the eye, or how far along parallel rays a site lies. Unsigned keys are in the order of the floats,
// negative ones included.
uint sortKey(Chunk chunk, uint local) {
  Ball ball = ballOfSite(chunk, local);
  bool isParallel = lensClass == kLensClassOrthographic;
  float order = isParallel ? dot(ball.centre, FRAME.forward.xyz) : powerOfOrigin(ball.centre, ball.radius);
  uint bits = floatBitsToUint(order);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

// Visible cells of the workgroups before, and their planes: this thread's share of the sum.
uvec2 shareOfSumBefore(uint group) {
  uint thread = gl_LocalInvocationIndex;
  uint ownSuper = group / kGroupSize;
  uvec2 sum = uvec2(0);
  for (uint i = thread; i < ownSuper; i += kGroupSize) sum = saturatingAdd(sum, FRAME.superSums.v[i]);
  uint other = ownSuper * kGroupSize + thread;
  return other < group ? saturatingAdd(sum, FRAME.groupSums.v[other]) : sum;
}

// Slots that the workgroup's cells before this thread's take, and the word with its bit.
uint slotInGroup(uint group, out uint word) {
  uint thread = gl_LocalInvocationIndex;
  uint firstWord = group * kMaskWords;
  uint slot = 0;
  for (uint i = 0; i < thread / 32; ++i) slot += bitCount(FRAME.visibility.v[firstWord + i].x);
  word = FRAME.visibility.v[firstWord + thread / 32].x;
  return slot + bitCount(word & ((1u << (thread % 32)) - 1));
}

void listCell(uint slot, uvec4 cell, uint key) {
  FRAME.visibleCells.v[slot] = cell;
  if (isWalk()) return;  // which sorts nothing
  FRAME.order.v[slot] = slot;
  FRAME.cellKeys.v[slot] = key;
  UintArray histogram = FRAME.cellHistogram;
  countDigit(histogram, slot, digitOf(key, 0));
}

// By the workgroup that loses the first cell, or else by the last one.
void planVisible(uint kept) {
  COUNTERS.visibleCells = kept;
  COUNTERS.expandDispatch = dispatchOf(groupsOver(kept, kGroupSize / lanesPerCell()));
  COUNTERS.detailDispatch = dispatchOf(groupsOver(kept * detailCount, kGroupSize));
  COUNTERS.cellSortDispatch = dispatchOf(groupsOver(kept, keysPerSortGroup()));
  COUNTERS.tileDispatch = dispatchOf(groupsOver(kept, kTileCellsPerGroup));
}

bool haveSpace(uvec2 sum) {
  return sum.x <= FRAME.visibleCapacity && (sum.y <= FRAME.planeCapacity || isWalk());
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint groups = FRAME.groupCount;
  uint group = linearGroup();
  if (group >= groups) return;
  bool isLast = group == groups - 1;
  uvec2 ownSum = FRAME.groupSums.v[group];
  if (ownSum.x == 0 && !isLast) return;
  Chunk chunk = loadChunk(chunkOfGroup(group));
  uint local = firstCellOfGroup(chunk, group) + thread;
  if (thread == 0) lostSlot = kNoCell;

  uint word;
  uint slot = slotInGroup(group, word);
  bool isVisible = (word >> (thread % 32) & 1u) != 0;
  uint planeCount = isVisible ? planeCountOf(chunk, local) : 0;
  uint key = isVisible && !isWalk() ? sortKey(chunk, local) : 0;
  uvec3 total;
  uint plane = scanExclusive(uvec3(planeCount, shareOfSumBefore(group)), total).x;
  uvec2 before = total.yz;
  slot += before.x;
  plane = saturatingAdd(plane, before.y);
  if (thread % 32 == 0) FRAME.visibility.v[group * kMaskWords + thread / 32].y = slot;
  uint planeEnd = saturatingAdd(plane, planeCount);
  if (isVisible && haveSpace(uvec2(slot + 1, planeEnd))) {
    listCell(slot, uvec4(chunk.index, local, plane, planeEnd <= FRAME.planeCapacity ? planeCount : 0), key);
  } else if (isVisible) {
    atomicMin(lostSlot, slot);
    atomicAnd(FRAME.visibility.v[group * kMaskWords + thread / 32].x, ~(1u << (thread % 32)));
  }
  barrier();

  if (thread != 0) return;
  uvec2 sum = saturatingAdd(before, ownSum);
  if (isLast) {
    COUNTERS.cellsWanted = sum.x + COUNTERS.droppedCells;
    COUNTERS.planesWanted = saturatingAdd(sum.y, COUNTERS.droppedPlanes);
  }
  if (haveSpace(sum) ? isLast : haveSpace(before)) planVisible(min(sum.x, lostSlot));
}
