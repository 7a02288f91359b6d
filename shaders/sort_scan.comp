// Radix sort, 2 of 3: a workgroup per digit turns its row into sums of the workgroups before, and stores the total.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_SORT
#include "gpu/sort.glsl"
#include "gpu/workgroup.glsl"

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint digit = gl_WorkGroupID.x;
  uint groups = sortGroups();
  uint carry = 0;
  for (uint round = 0; round < groups; round += kGroupSize) {
    uint group = round + thread;
    uint value = group < groups ? FRAME.histogram.v[histogramIndex(digit, group)] : 0;
    uint total;
    uint before = scanExclusive(value, total);
    if (group < groups) FRAME.histogram.v[histogramIndex(digit, group)] = carry + before;
    carry += total;
  }
  if (thread == 0) FRAME.histogram.v[digit] = carry;
}
