// Sums, scans and ranks over a workgroup of kGroupSize threads, in shared memory: no subgroup operations, so every device
// gives the same result. All functions hold barriers: call them in uniform control flow.
#ifndef FROTH_GPU_WORKGROUP_GLSL
#define FROTH_GPU_WORKGROUP_GLSL
#include "gpu/layout.h"

shared uint scanValues[kGroupSize];

// Unsigned sum that stops at the largest number; associative, so scans may use it.
uint saturatingAdd(uint a, uint b) {
  uint sum = a + b;
  return sum < a ? 0xffffffffu : sum;
}

// Sum of the values of the threads before this one; `total` over all.
uint scanExclusive(uint value, out uint total) {
  uint thread = gl_LocalInvocationIndex;
  barrier();
  scanValues[thread] = value;
  barrier();
  for (uint stride = 1; stride < kGroupSize; stride *= 2) {
    uint before = thread >= stride ? scanValues[thread - stride] : 0;
    barrier();
    scanValues[thread] = saturatingAdd(scanValues[thread], before);
    barrier();
  }
  total = scanValues[kGroupSize - 1];
  return thread > 0 ? scanValues[thread - 1] : 0;
}

#endif
