// What every pass knows: the frame's block by push constant, specialization, checked indices.
#ifndef FROTH_GPU_FRAME_GLSL
#define FROTH_GPU_FRAME_GLSL
#extension GL_EXT_buffer_reference : require
#include "gpu/grid.glsl"
#include "gpu/layout.h"

layout(constant_id = kConstantCheckIndices) const bool checkIndices = false;
layout(constant_id = kConstantIsFull) const bool isFull = true;
layout(constant_id = kConstantLensClass) const uint lensClass = kLensClassPinhole;
layout(constant_id = kConstantFloatColours) const bool floatColours = false;
layout(constant_id = kConstantKeepsQuarters) const bool keepsQuarters = false;

#if defined(FROTH_SORT)
layout(push_constant) uniform Push {
  FrameRef frame;
  UintArray keysIn, valuesIn, keysOut, valuesOut, count;
  UintQuadArray histogram;
  UintArray nextHistogram;
  uint shift, capacity, step;
} push;
#else
layout(push_constant) uniform Push {
  FrameRef frame;
  uint partCount, padding;
  FrameRef parts[kMostInstances];
} push;
#endif

// Shaders that see several instances name the one at hand.
#if defined(FROTH_MERGED)
FrameRef frameAtHand;
#define FRAME frameAtHand.v
void selectPart(uint part) { frameAtHand = push.parts[part]; }
#else
#define FRAME push.frame.v
#endif
#define COUNTERS FRAME.counters.v
#define kInfinity uintBitsToFloat(0x7f800000u)

bool isWalk() { return (FRAME.flags & kFlagWalk) != 0; }

uint lanesPerCell() { return isWalk() ? kWalkLanes : kRasterLanes; }

// Keys that a workgroup ranks in a pass of a radix sort.
uint keysPerSortGroup() { return kGroupSize * FRAME.sortRounds; }

// Every access to an array goes through this: with checkIndices an index out of range is counted and clamped.
uint checked(uint index, uint count) {
  if (checkIndices && index >= count) {
    atomicAdd(COUNTERS.violations, 1u);
    return count > 0 ? count - 1 : 0;
  }
  return index;
}

#endif
