// Tells walks where the border cells of a chunk are that was not drawn before: table[border] = cell. A thread per border.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#include "gpu/grid.glsl"
#include "gpu/layout.h"

layout(local_size_x = kGroupSize) in;

layout(push_constant) uniform Push {
  UintArray borders, borderCells, borderNumbers;
  uint count, firstCode;
  uint slot, slotPlace;
} push;

void main() {
  uint index = linearGroup() * kGroupSize + gl_LocalInvocationIndex;
  if (index == 0) push.borders.v[push.slotPlace] = push.slot;
  if (index < push.count) push.borders.v[push.borderNumbers.v[index]] = push.firstCode | push.borderCells.v[index];
}
