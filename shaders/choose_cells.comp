// Finds the least size key from which on all cells in view have room, and plans that cull_cells.comp leaves out those
// below it. One workgroup; each thread has some keys that follow each other, the first one those of the largest cells.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/cell_sizes.glsl"
#define FROTH_SCANNED uvec3
#include "gpu/workgroup.glsl"

layout(local_size_x = kGroupSize) in;

const uint kKeysPerThread = kSizeKeys / kGroupSize;

shared uint leastKey;    // from which on there is room
shared uint largestKey;  // of a cell in view

bool haveRoom(uvec2 sum) { return sum.x <= FRAME.visibleCapacity && sum.y <= FRAME.planeCapacity; }

uvec2 sumOf(uint firstKey, uint endKey) {
  uvec2 sum = uvec2(0);
  for (uint key = firstKey; key < endKey; ++key) sum = saturatingAdd(sum, FRAME.sizeCounts.v[key]);
  return sum;
}

// How many (tile, cell) pairs the cells of these keys would have, if their balls lay anywhere in their tiles.
uint guessPairs(uint firstKey, uint endKey) {
  uint pairs = 0;
  for (uint key = firstKey; key < endKey; ++key) {
    float across = 2.0 * radiusOfClass(key / kKeysPerSize) / float(kTileSize) + 1.0;
    float each = min(across * across, float(FRAME.tilesX * FRAME.tilesY));
    pairs = saturatingAdd(pairs, uint(min(each * float(FRAME.sizeCounts.v[key].x), 4e9)));
  }
  return pairs;
}

// Of the thread's keys; sum: the cells and planes of all larger keys.
void findLeastKey(uint firstKey, uint endKey, uvec2 sum) {
  for (uint key = endKey; key-- > firstKey;) {
    uvec2 counts = FRAME.sizeCounts.v[key];
    if (counts.x > 0) atomicMax(largestKey, key);
    sum = saturatingAdd(sum, counts);
    if (haveRoom(sum)) atomicMin(leastKey, key);
  }
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint endKey = kSizeKeys - thread * kKeysPerThread;
  uint firstKey = endKey - kKeysPerThread;
  if (thread == 0) {
    leastKey = kSizeKeys;
    largestKey = 0;
  }
  uvec3 all;
  uvec2 sum = scanExclusive(uvec3(sumOf(firstKey, endKey), 0u), all).xy;
  findLeastKey(firstKey, endKey, sum);
  barrier();

  // Where not even the cells of the largest key have room, compact_cells.comp takes the first ones.
  uint least = min(leastKey, largestKey);
  uint endDropped = clamp(least, firstKey, endKey);
  uint pairs = isWalk() ? 0 : guessPairs(firstKey, endDropped);
  uvec3 dropped;
  scanExclusive(uvec3(sumOf(firstKey, endDropped), pairs), dropped);
  if (least == 0) return;
  uint supers = groupsOver(FRAME.groupCount, kGroupSize);
  for (uint i = thread; i < supers; i += kGroupSize) FRAME.superSums.v[i] = uvec2(0);
  if (thread != 0) return;
  COUNTERS.leastKey = least;
  COUNTERS.droppedCells = dropped.x;
  COUNTERS.droppedPlanes = dropped.y;
  COUNTERS.droppedPairs = dropped.z;
  COUNTERS.dropDispatch = dispatchOf(FRAME.groupCount);
}
