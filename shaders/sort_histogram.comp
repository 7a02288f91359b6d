// Radix sort, 1 of 3: how many keys of each workgroup have each digit. Rows by digit.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_SORT
#include "gpu/sort.glsl"

shared uint digits[kGroupSize];

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint group = linearGroup();
  digits[thread] = 0;
  barrier();
  for (uint round = 0; round < kSortKeysPerGroup; round += kGroupSize) {
    uint index = group * kSortKeysPerGroup + round + thread;
    if (index < keyCount()) atomicAdd(digits[digitOf(push.keysIn.v[index])], 1u);
  }
  barrier();
  if (group < sortGroups()) FRAME.histogram.v[histogramIndex(thread, group)] = digits[thread];
}
