// The descriptor set of rays in an engine's shader, and the instance at hand: what gpu/frame.glsl is to the passes of a
// view. FROTH_SLANG: for froth_walk.slang (bundle/bundle_shader.cpp).
#ifndef FROTH_GPU_WALK_SET_GLSL
#define FROTH_GPU_WALK_SET_GLSL
#if !defined(FROTH_SLANG)
#extension GL_EXT_buffer_reference : require
#endif
#include "gpu/walk_layout.h"

#if defined(FROTH_SLANG)
struct WalkSet {
  WalkBlock block;
};
[[vk::binding(kBindingWalk, FROTH_WALK_SET)]] ConstantBuffer<WalkSet> walkSet;
#if !defined(FROTH_WALK_NO_COUNTERS)
struct WalkCountersSet {
  WalkCounters v;
};
[[vk::binding(kBindingWalkCounters, FROTH_WALK_SET)]] RWStructuredBuffer<WalkCountersSet> walkCountersSet;
#define walkCounters walkCountersSet[0]

uint atomicAdd(__ref uint sum, uint amount) {
  uint before;
  InterlockedAdd(sum, amount, before);
  return before;
}
#endif
static uint instanceAtHand;
#else
layout(set = FROTH_WALK_SET, binding = kBindingWalk, std140) uniform WalkSet { WalkBlock block; } walkSet;
#if !defined(FROTH_WALK_NO_COUNTERS)
layout(set = FROTH_WALK_SET, binding = kBindingWalkCounters, std430)
    buffer WalkCountersSet { WalkCounters v; } walkCounters;
#endif
uint instanceAtHand;
#endif

// How much of the cells rays take as prepared (kPreparedNothing...), as a constant, for each form has its own code.
#if !defined(FROTH_WALK_PREPARED)
#define FROTH_WALK_PREPARED kPreparedNothing
#endif

#define FRAME walkSet.block.instances.v[instanceAtHand]
#define kInfinity uintBitsToFloat(0x7f800000u)

// Only what a caller gives is out of range; the asset's own indices were checked when it was loaded.
// FROTH_WALK_CHECK_INDICES: an expression that tells whether to count and clamp all.
uint checked(uint index, uint count) {
#if defined(FROTH_WALK_CHECK_INDICES)
  if (FROTH_WALK_CHECK_INDICES && index >= count) {
    atomicAdd(walkCounters.v.violations, 1u);
    return count > 0 ? count - 1 : 0;
  }
#endif
  return index;
}

// FROTH_WALK_COUNTS: an expression that tells whether work is counted at all; as a constant it frees the registers.
void countWalkWork(uint kind, uint amount) {
#if defined(FROTH_WALK_COUNTS)
  if (!FROTH_WALK_COUNTS) return;
#endif
#if !defined(FROTH_WALK_NO_COUNTERS)
  if ((walkSet.block.flags & kWalkCountsWork) == 0 || amount == 0) return;
  uint before = atomicAdd(walkCounters.v.work[2 * kind], amount);
  if (before + amount < before) atomicAdd(walkCounters.v.work[2 * kind + 1], 1u);
#endif
}

#endif
