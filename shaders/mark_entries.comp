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

const uint kMostOwnEntries = 64;  // balls that meet more are marked by all threads together

shared uint largeCells[kRayGroupSize];
shared uint largeCount;

// Entries that a ball meets, and the first and the last of its parts.
struct Reach {
  uvec3 lowPart, highPart;
  uvec3 low, extent;  // of entries
};

Reach reachOf(Ball ball) {
  vec3 reach = ball.radius * partsPerUnit() + kPartGuard;
  uvec3 lowPart = partAt(placeInParts(ball.centre) - reach);
  uvec3 highPart = partAt(placeInParts(ball.centre) + reach);
  uvec3 low = lowPart / kPartsAlong;
  return Reach(lowPart, highPart, low, highPart / kPartsAlong - low + 1);
}

uint countEntries(Reach reach) { return reach.extent.x * reach.extent.y * reach.extent.z; }

// The parts of the entry that lie within reach: bits as of bitOfPart().
uvec2 partsWithin(Reach reach, uvec3 entry) {
  uvec3 corner = entry * kPartsAlong;
  uvec3 low = max(reach.lowPart, corner) - corner;
  uvec3 high = min(reach.highPart, corner + kPartsAlong - 1) - corner;
  uint row = (2u << high.x) - (1u << low.x);
  uint layer = 0;
  for (uint y = low.y; y <= high.y; ++y) layer |= row << kPartsAlong * y;
  uvec2 parts = uvec2(0u);
  for (uint z = low.z; z <= high.z; ++z) parts[z / 2] |= layer << 16 * (z % 2);
  return parts;
}

// Marks every `step`th of the entries that the ball meets, from `first` on.
void markEntries(Reach reach, uint first, uint step) {
  uint count = countEntries(reach);
  for (uint i = first; i < count; i += step) {
    uint row = i / reach.extent.x;
    uvec3 entry = reach.low + uvec3(i % reach.extent.x, row % reach.extent.y, row / reach.extent.y);
    uvec2 parts = partsWithin(reach, entry);
    uint index = entryOfPart(entry * kPartsAlong);
    if (parts.x != 0) atomicOr(FRAME.entries.v[index].z, parts.x);
    if (parts.y != 0) atomicOr(FRAME.entries.v[index].w, parts.y);
  }
}

// Every thread of the workgroup calls it. A thread marks a cell; all together mark what reaches far, so that none waits
// for one thread.
void markCells(Chunk chunk, uint firstCell) {
  uint lane = gl_LocalInvocationIndex;
  if (lane == 0) largeCount = 0;
  barrier();
  uint cell = firstCell + lane;
  if (cell < chunk.liveCount) {
    Reach reach = reachOf(ballOfSite(chunk, cell));
    if (countEntries(reach) > kMostOwnEntries) largeCells[atomicAdd(largeCount, 1u)] = cell;
    else markEntries(reach, 0u, 1u);
  }
  barrier();
  for (uint i = 0; i < largeCount; ++i) {
    markEntries(reachOf(ballOfSite(chunk, largeCells[i])), lane, kRayGroupSize);
  }
  barrier();
}

void main() {
  instanceAtHand = push.instance;
  uint index = gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y;
  if (index >= FRAME.chunkCount) return;
  Chunk chunk = loadChunk(index);
  uint stride = gl_NumWorkGroups.x * kRayGroupSize;
  for (uint cell = gl_WorkGroupID.x * kRayGroupSize; cell < chunk.liveCount; cell += stride) markCells(chunk, cell);
}
