// Counts what rays cost, where the pipelines were made for it; otherwise the code is not there.
#ifndef FROTH_GPU_WORK_GLSL
#define FROTH_GPU_WORK_GLSL
#include "gpu/frame.glsl"

layout(constant_id = kConstantCountWork) const bool countsWork = false;

// kind: kWork...
void countWork(uint kind, uint amount) {
  if (!countsWork) return;
  uint before = atomicAdd(COUNTERS.work[2 * kind], amount);
  if (before + amount < before) atomicAdd(COUNTERS.work[2 * kind + 1], 1u);
}

#endif
