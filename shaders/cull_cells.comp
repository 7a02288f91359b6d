// Which live cells this view can see: near tests, then the solid ball against all rays of the view. For a walk the
// cells that only guide it are listed too. A thread per cell; a bit per cell and, per workgroup and per kGroupSize
// of these, the count of visible cells and of their planes.
//
// With kFlagCountSizes it also counts the cells by their size on screen. If choose_cells.comp then finds no room for
// all, it runs once more and leaves out those below the least size that has room.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/cell_sizes.glsl"
#include "gpu/pixels.glsl"
#include "foam/cell.h"

layout(local_size_x = kGroupSize) in;

shared uint maskWords[kMaskWords];
shared uint planes;

// solid: the ball that is seen; of cells that only guide walks one without a radius.
bool isInView(Chunk chunk, uint cell, out Ball solid) {
  solid = Ball(vec3(0.0), 0.0);
  if (cell >= chunk.liveCount) return cell < chunk.cellCount && isWalk();
  Ball ball = ballOfSite(chunk, cell);
  // One load: lavapipe of Mesa 22.3 mixes up the components where a vector and one of its parts are loaded apart.
  vec4 forward = FRAME.forward;
  if (isNearCell(ball.centre, ball.radius, forward.xyz, FRAME.nearRatio, forward.w)) return false;
  solid = solidBall(ball, solidBallBytes(chunk.index, cell));
  return pixelsMeetBall(solid.centre, solid.radius, uvec2(0), max(FRAME.regionWidth, FRAME.regionHeight));
}

// Of a cell in view: whether it stays. All do until choose_cells.comp has chosen.
bool hasRoom(Chunk chunk, uint cell, Ball solid) {
  if ((FRAME.flags & kFlagCountSizes) == 0) return true;
  uint key = sizeKey(chunk, cell, solid);
  if (COUNTERS.leastKey != 0) return key >= COUNTERS.leastKey;
  atomicAdd(FRAME.sizeCounts.v[key].x, 1u);
  // A walk needs no planes, but shows the cells that a raster shows.
  if (cell < chunk.liveCount) atomicAdd(FRAME.sizeCounts.v[key].y, alphaCountOf(chunk, cell));
  return true;
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint groups = FRAME.groupCount;
  uint group = linearGroup();
  if (group >= groups) return;
  Chunk chunk = loadChunk(chunkOfGroup(group));
  uint local = firstCellOfGroup(chunk, group) + thread;
  if (thread < kMaskWords) maskWords[thread] = 0;
  if (thread == 0) planes = 0;
  barrier();

  Ball solid;
  if (isInView(chunk, local, solid) && hasRoom(chunk, local, solid)) {
    atomicOr(maskWords[thread / 32], 1u << (thread % 32));
    atomicAdd(planes, planeCountOf(chunk, local));
  }
  barrier();

  if (thread < kMaskWords) {
    FRAME.visibility.v[checked(group * kMaskWords + thread, groups * kMaskWords)] = uvec2(maskWords[thread], 0);
  }
  if (thread == 0) {
    uint cells = 0;
    for (uint word = 0; word < kMaskWords; ++word) cells += bitCount(maskWords[word]);
    FRAME.groupSums.v[checked(group, groups)] = uvec2(cells, planes);
    if (cells > 0) atomicAdd(FRAME.superSums.v[group / kGroupSize].x, cells);
    if (planes > 0) atomicAdd(FRAME.superSums.v[group / kGroupSize].y, planes);
  }
}
