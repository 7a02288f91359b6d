// A stable radix sort of 32-bit keys with 32-bit values, eight bits a pass: histogram -> scan -> scatter. Needs neither a
// subgroup size nor forward progress between workgroups.
#ifndef FROTH_GPU_SORT_GLSL
#define FROTH_GPU_SORT_GLSL
#include "gpu/frame.glsl"

layout(local_size_x = kGroupSize) in;

uint keyCount() { return min(push.count.v[0], push.capacity); }
uint sortGroups() { return (keyCount() + kSortKeysPerGroup - 1) / kSortKeysPerGroup; }
uint digitOf(uint key) { return key >> push.shift & 255u; }

// The histogram holds the totals of the digits, then a row of workgroups for each digit.
uint histogramIndex(uint digit, uint group) {
  return checked(kGroupSize + digit * sortGroups() + group, FRAME.histogramCapacity);
}

#endif
