// One digit of a stable radix sort of 32-bit keys with 32-bit values: moves keys and values to their place. Each workgroup
// sums the histogram rows of those before it; the keys' next digits are counted where the keys arrive, so a digit costs one
// dispatch. Needs neither a subgroup size nor forward progress between workgroups.
//
// Within a round of kGroupSize keys the rank among equal digits is counted in bit masks by digit, so equal keys keep their
// order.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_SORT
#include "gpu/histogram.glsl"
#include "gpu/workgroup.glsl"

layout(local_size_x = kGroupSize) in;

shared uint masks[kSortDigits][kMaskWords];  // [digit] a bit per thread that holds it
shared uint places[kSortDigits];             // [digit] where its next key goes

// Where the first key of `group` with this digit goes. A thread per digit.
uint firstPlace(uint group, uint groups, uint digit) {
  uint ownSum = group / kSortGroupsPerSum;
  uint total = 0;
  uint before = 0;
  for (uint sum = 0; sum < groupsOver(groups, kSortGroupsPerSum); ++sum) {
    uint count = push.histogram.v[sumPlace(sum, digit)];
    total += count;
    if (sum < ownSum) before += count;
  }
  for (uint i = ownSum * kSortGroupsPerSum; i < group; ++i) before += push.histogram.v[rowPlace(i, digit)];
  uint keys;
  return scanExclusive(total, keys) + before;
}

uint rankAmongEqual(uint digit, uint thread) {
  uint rank = bitCount(masks[digit][thread / 32] & ((1u << (thread % 32)) - 1));
  for (uint word = 0; word < thread / 32; ++word) rank += bitCount(masks[digit][word]);
  return rank;
}

void takeTileCount(uint visible, uint slot) {
  uint count = FRAME.slotTiles.v[checked(slot, FRAME.visibleCapacity)];
  FRAME.tileCounts.v[visible] = count;
  atomicAdd(FRAME.tileSums.v[visible / kCellsPerTileSum], count);
}

void extendRange(uint tile, uint pair) {
  uint i = checked(tile, FRAME.tilesX * FRAME.tilesY);
  atomicMax(FRAME.tileRanges.v[i].x, ~pair);
  atomicMax(FRAME.tileRanges.v[i].y, pair + 1);
}

void moveKey(uint place, uint key, uint value) {
  push.keysOut.v[place] = key;
  push.valuesOut.v[place] = value;
  UintArray nextHistogram = push.nextHistogram;
  if (push.step == kSortCountNextDigit) countDigit(nextHistogram, place, digitOf(key, push.shift + 8));
  if (push.step == kSortTakeTileCounts) takeTileCount(place, value);
  if (push.step == kSortFindRanges) extendRange(key, place);
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint group = linearGroup();
  uint keys = min(push.count.v[0], push.capacity);
  uint groups = groupsOver(keys, kSortKeysPerGroup);
  if (group >= groups) return;
  places[thread] = firstPlace(group, groups, thread);

  for (uint round = 0; round < kSortKeysPerGroup; round += kGroupSize) {
    for (uint word = 0; word < kMaskWords; ++word) masks[thread][word] = 0;
    barrier();
    uint index = group * kSortKeysPerGroup + round + thread;
    bool isKey = index < keys;
    uint key = isKey ? push.keysIn.v[index] : 0;
    uint digit = digitOf(key, push.shift);
    if (isKey) atomicOr(masks[digit][thread / 32], 1u << (thread % 32));
    barrier();
    if (isKey) {
      uint place = checked(places[digit] + rankAmongEqual(digit, thread), push.capacity);
      moveKey(place, key, push.valuesIn.v[index]);
    }
    barrier();
    for (uint word = 0; word < kMaskWords; ++word) places[thread] += bitCount(masks[thread][word]);
  }
}
