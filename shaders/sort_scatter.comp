// Radix sort, 3 of 3: moves keys and values to their place. Within a round of kGroupSize keys the rank among equal digits
// is counted in bit masks by digit, so equal keys keep their order.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_SORT
#include "gpu/sort.glsl"
#include "gpu/workgroup.glsl"

shared uint masks[kGroupSize][kMaskWords];  // [digit] a bit per thread that holds it
shared uint places[kGroupSize];             // [digit] where its next key goes

uint rankAmongEqual(uint digit, uint thread) {
  uint rank = bitCount(masks[digit][thread / 32] & ((1u << (thread % 32)) - 1));
  for (uint word = 0; word < thread / 32; ++word) rank += bitCount(masks[digit][word]);
  return rank;
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint group = linearGroup();
  if (group >= sortGroups()) return;

  uint total;
  uint digitStart = scanExclusive(FRAME.histogram.v[thread], total);
  places[thread] = digitStart + FRAME.histogram.v[histogramIndex(thread, group)];

  for (uint round = 0; round < kSortKeysPerGroup; round += kGroupSize) {
    for (uint word = 0; word < kMaskWords; ++word) masks[thread][word] = 0;
    barrier();
    uint index = group * kSortKeysPerGroup + round + thread;
    bool isKey = index < keyCount();
    uint key = isKey ? push.keysIn.v[index] : 0;
    uint digit = digitOf(key);
    if (isKey) atomicOr(masks[digit][thread / 32], 1u << (thread % 32));
    barrier();
    if (isKey) {
      uint place = checked(places[digit] + rankAmongEqual(digit, thread), push.capacity);
      push.keysOut.v[place] = key;
      push.valuesOut.v[place] = push.valuesIn.v[index];
    }
    barrier();
    for (uint word = 0; word < kMaskWords; ++word) places[thread] += bitCount(masks[thread][word]);
  }
}
