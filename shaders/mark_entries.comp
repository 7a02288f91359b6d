// Marks the parts of the grid that the balls of the live cells meet that are drawn. A row of workgroups per chunk: as many
// as the mean chunk has cells for; in a larger chunk each thread takes several.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#include "gpu/walk_entries.glsl"

layout(local_size_x = kRayGroupSize) in;

layout(push_constant) uniform Push {
  uint instance;
} push;

const uint kMostOwnParts = 4096;  // a larger ball marks whole entries

void markPart(uvec3 part) {
  uint entry = entryOfPart(part);
  uint bit = bitOfPart(part);
  if (bit < 32) atomicOr(FRAME.entries.v[entry].z, 1u << bit);
  else atomicOr(FRAME.entries.v[entry].w, 1u << (bit - 32));
}

void markEntry(uvec3 part) {
  uint entry = entryOfPart(part);
  atomicOr(FRAME.entries.v[entry].z, ~0u);
  atomicOr(FRAME.entries.v[entry].w, ~0u);
}

void markBall(Ball ball) {
  vec3 reach = ball.radius * partsPerUnit() + kPartGuard;
  uvec3 low = partAt(placeInParts(ball.centre) - reach);
  uvec3 high = partAt(placeInParts(ball.centre) + reach);
  uvec3 extent = high - low + 1;
  bool isLarge = extent.x * extent.y * extent.z > kMostOwnParts;
  uint step = isLarge ? kPartsAlong : 1;
  if (isLarge) low -= low % kPartsAlong;
  for (uint z = low.z; z <= high.z; z += step) {
    for (uint y = low.y; y <= high.y; y += step) {
      for (uint x = low.x; x <= high.x; x += step) {
        if (isLarge) markEntry(uvec3(x, y, z));
        else markPart(uvec3(x, y, z));
      }
    }
  }
}

void main() {
  instanceAtHand = push.instance;
  uint index = gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y;
  if (index >= FRAME.chunkCount) return;
  Chunk chunk = loadChunk(index);
  uint stride = gl_NumWorkGroups.x * kRayGroupSize;
  for (uint cell = gl_GlobalInvocationID.x; cell < chunk.liveCount; cell += stride) markBall(ballOfSite(chunk, cell));
}
