// The entries of a new asset, or of other chunks that are drawn of it: for each box of the grid the cell that holds its
// middle, and no marked part. A thread per entry.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#include "gpu/descend.glsl"
#include "gpu/grid.glsl"
#include "gpu/walk_entries.glsl"

layout(local_size_x = kRayGroupSize) in;

layout(push_constant) uniform Push {
  uint instance;
} push;

void main() {
  instanceAtHand = push.instance;
  uint index = linearGroup() * kRayGroupSize + gl_LocalInvocationIndex;
  uint along = FRAME.entriesAlong;
  if (index >= along * along * along) return;
  uvec3 entry = uvec3(index % along, index / along % along, index / (along * along));
  vec4 low = FRAME.boxLow, size = FRAME.boxSize;
  vec3 middle = low.xyz + (vec3(entry) + 0.5) / float(along) * size.xyz;
  uint neighbours = 0;
  uvec2 first = hasLevels() ? FRAME.entries.v[index].xy : firstCell();  // of the chunks before, or no cell
  FRAME.entries.v[index] = uvec4(cellHolding(middle, isCell(first) ? first : firstCell(), neighbours), 0u, 0u);
}
