// Histograms of a radix sort's digits: a row of counts per workgroup, and before each
// kSortGroupsPerSum of these rows one of their sums. They start at zero, and whoever puts a key in its place counts it.
#ifndef FROTH_GPU_HISTOGRAM_GLSL
#define FROTH_GPU_HISTOGRAM_GLSL
#include "gpu/frame.glsl"

const uint kRowsPerSum = kSortGroupsPerSum + 1;

uint digitOf(uint key, uint shift) { return key >> shift & (kSortDigits - 1); }

uint sumRow(uint sum) { return sum * kRowsPerSum; }
uint groupRow(uint group) { return group + group / kSortGroupsPerSum + 1; }

void countDigit(UintArray histogram, uint place, uint digit) {
  uint group = place / keysPerSortGroup();
  atomicAdd(histogram.v[groupRow(group) * kSortDigits + digit], 1u);
  atomicAdd(histogram.v[sumRow(group / kSortGroupsPerSum) * kSortDigits + digit], 1u);
}

#endif
