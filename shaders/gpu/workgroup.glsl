// Sums, scans and ranks over a workgroup of kGroupSize threads, in shared memory: no subgroup operations, so every device
// gives the same result. All functions hold barriers: call them in uniform control flow.
#ifndef FROTH_GPU_WORKGROUP_GLSL
#define FROTH_GPU_WORKGROUP_GLSL
#include "gpu/layout.h"

shared uint scanValues[2][kGroupSize];
shared uvec2 sumValues[kGroupSize];

// Unsigned sum that stops at the largest number; associative, so scans may use it.
uint saturatingAdd(uint a, uint b) {
  uint sum = a + b;
  return sum < a ? 0xffffffffu : sum;
}

uvec2 saturatingAdd(uvec2 a, uvec2 b) { return uvec2(saturatingAdd(a.x, b.x), saturatingAdd(a.y, b.y)); }

// Sum of the values of the threads before this one; `total` over all.
uint scanExclusive(uint value, out uint total) {
  uint thread = gl_LocalInvocationIndex;
  uint from = 0;
  barrier();
  scanValues[0][thread] = value;
  for (uint stride = 1; stride < kGroupSize; stride *= 2) {
    barrier();
    uint before = thread >= stride ? scanValues[from][thread - stride] : 0;
    scanValues[1 - from][thread] = saturatingAdd(scanValues[from][thread], before);
    from = 1 - from;
  }
  barrier();
  total = scanValues[from][kGroupSize - 1];
  return thread > 0 ? scanValues[from][thread - 1] : 0;
}

// Sum over the workgroup.
uvec2 sumOfThreads(uvec2 value) {
  uint thread = gl_LocalInvocationIndex;
  barrier();
  sumValues[thread] = value;
  for (uint stride = kGroupSize / 2; stride > 0; stride /= 2) {
    barrier();
    if (thread < stride) sumValues[thread] = saturatingAdd(sumValues[thread], sumValues[thread + stride]);
  }
  barrier();
  return sumValues[0];
}

#endif
