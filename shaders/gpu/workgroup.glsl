// Scan over a workgroup of kGroupSize threads, in shared memory: no subgroup operations, so every device gives the same
// result. FROTH_SCANNED is what is scanned: uint, unless a pass has several sums to form at once.
#ifndef FROTH_GPU_WORKGROUP_GLSL
#define FROTH_GPU_WORKGROUP_GLSL
#include "gpu/layout.h"

#if !defined(FROTH_SCANNED)
#define FROTH_SCANNED uint
#endif

shared FROTH_SCANNED scanValues[2][kGroupSize];

// Unsigned sum that stops at the largest number; associative, so scans may use it.
uint saturatingAdd(uint a, uint b) {
  uint sum = a + b;
  return sum < a ? 0xffffffffu : sum;
}

uvec2 saturatingAdd(uvec2 a, uvec2 b) { return uvec2(saturatingAdd(a.x, b.x), saturatingAdd(a.y, b.y)); }
uvec3 saturatingAdd(uvec3 a, uvec3 b) { return uvec3(saturatingAdd(a.xy, b.xy), saturatingAdd(a.z, b.z)); }

// Sum of the values of the threads before this one; `total` over all. Holds barriers: call it in uniform control flow.
FROTH_SCANNED scanExclusive(FROTH_SCANNED value, out FROTH_SCANNED total) {
  uint thread = gl_LocalInvocationIndex;
  uint from = 0;
  barrier();
  scanValues[0][thread] = value;
  for (uint stride = 1; stride < kGroupSize; stride *= 2) {
    barrier();
    FROTH_SCANNED before = thread >= stride ? scanValues[from][thread - stride] : FROTH_SCANNED(0);
    scanValues[1 - from][thread] = saturatingAdd(scanValues[from][thread], before);
    from = 1 - from;
  }
  barrier();
  total = scanValues[from][kGroupSize - 1];
  return thread > 0 ? scanValues[from][thread - 1] : FROTH_SCANNED(0);
}

#endif
