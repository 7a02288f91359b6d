// One digit of a stable radix sort of 32-bit keys with 32-bit values: moves keys and values to their place. Each
// workgroup sums the histogram rows of those before it; the keys' next digits are counted where the keys arrive, so a
// digit costs one dispatch. Needs neither a subgroup size nor forward progress between workgroups.
//
// Within a round of kGroupSize keys the rank among equal digits is counted in bit masks by digit, so equal keys keep
// their order.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_SORT
#include "gpu/histogram.glsl"
#include "gpu/workgroup.glsl"

layout(local_size_x = kGroupSize) in;

const uint kRounds = FROTH_ROUNDS;  // FrameBlock::sortRounds
const uint kKeysPerGroup = kRounds * kGroupSize;
const uint kRowQuads = kSortDigits / 4;            // a row is read by so many threads,
const uint kRowsAtOnce = kGroupSize / kRowQuads;   // so many rows at once

shared uint masks[kSortDigits][kMaskWords];  // [digit] a bit per thread that holds it
shared uint totals[kSortDigits];             // [digit] keys with it
shared uint places[kSortDigits];             // [digit] where the workgroup's next key goes

// Sets `totals`, and `places` to the keys of the groups before. Ends with a barrier.
void sumRows(uint group, uint groups) {
  uint thread = gl_LocalInvocationIndex;
  uint quad = thread % kRowQuads;
  uint firstRow = thread / kRowQuads;
  uint ownSum = group / kSortGroupsPerSum;
  uvec4 total = uvec4(0);
  uvec4 before = uvec4(0);
  for (uint sum = firstRow; sum < groupsOver(groups, kSortGroupsPerSum); sum += kRowsAtOnce) {
    uvec4 counts = push.histogram.v[sumRow(sum) * kRowQuads + quad];
    total += counts;
    if (sum < ownSum) before += counts;
  }
  for (uint i = ownSum * kSortGroupsPerSum + firstRow; i < group; i += kRowsAtOnce) {
    before += push.histogram.v[groupRow(i) * kRowQuads + quad];
  }
  totals[thread] = 0;
  places[thread] = 0;
  barrier();
  for (uint i = 0; i < 4; ++i) {
    atomicAdd(totals[4 * quad + i], total[i]);
    atomicAdd(places[4 * quad + i], before[i]);
  }
  barrier();
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

void moveKey(uint place, uint key, uint value) {
  push.keysOut.v[place] = key;
  push.valuesOut.v[place] = value;
  UintArray nextHistogram = push.nextHistogram;
  if (push.step == kSortCountNextDigit) countDigit(nextHistogram, place, digitOf(key, push.shift + 8));
  if (push.step == kSortTakeTileCounts) takeTileCount(place, value);
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint group = linearGroup();
  uint first = group * kKeysPerGroup + thread;
  uint keys[kRounds];  // loaded before anything waits; what lies behind the last key is not used
  uint values[kRounds];
  for (uint round = 0; round < kRounds; ++round) {
    uint index = min(first + round * kGroupSize, push.capacity - 1);
    keys[round] = push.keysIn.v[index];
    values[round] = push.valuesIn.v[index];
  }
  uint count = min(push.count.v[0], push.capacity);
  uint groups = groupsOver(count, kKeysPerGroup);
  if (group >= groups) return;
  sumRows(group, groups);
  uint all;
  places[thread] += scanExclusive(totals[thread], all);

  for (uint round = 0; round < kRounds; ++round) {
    for (uint word = 0; word < kMaskWords; ++word) masks[thread][word] = 0;
    barrier();
    bool isKey = first + round * kGroupSize < count;
    uint digit = digitOf(keys[round], push.shift);
    if (isKey) atomicOr(masks[digit][thread / 32], 1u << (thread % 32));
    barrier();
    if (isKey) {
      uint place = checked(places[digit] + rankAmongEqual(digit, thread), push.capacity);
      moveKey(place, keys[round], values[round]);
    }
    barrier();
    for (uint word = 0; word < kMaskWords; ++word) places[thread] += bitCount(masks[thread][word]);
  }
}
