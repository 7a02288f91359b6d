// What every ray through the eye shares of a visible cell: its frame, and its radical planes as eye planes, those that
// only lower tFar first.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/cell_bits.glsl"
#include "foam/cell.h"

layout(local_size_x = kGroupSize) in;

// Rows n, t, b of the rotation matrix of a unit quaternion (w, x, y, z).
void setFrame(vec4 quaternion, inout CellRecord record) {
  float w = quaternion.x, x = quaternion.y, y = quaternion.z, z = quaternion.w;
  record.face.xyz = vec3(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y));
  record.tangent.xyz = vec3(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x));
  record.bitangent.xyz = vec3(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y));
}

void expandPlanes(Chunk chunk, uvec4 cell, vec4 siteRadius, inout CellRecord record) {
  uint row = neighbourRow(chunk, cell.y).x;
  uint low = cell.z;
  uint high = cell.z + cell.w;
  record.planeBegin = low;
  record.planeEnd = high;
  for (uint i = 0; i < cell.w; ++i) {
    vec4 otherSite = siteRadiusOf(chunk, neighbourAt(chunk, row + i));
    vec3 toNeighbour = fromSiteToSite(siteRadius.xyz, otherSite.xyz);
    float clearance = radicalClearance(record.ball.xyz, toNeighbour, radicalOffset(toNeighbour, siteRadius.w, otherSite.w));
    uint place = clearance >= 0.0 ? low++ : --high;
    FRAME.planes.v[checked(place, FRAME.planeCapacity)] = vec4(eyePlane(toNeighbour, clearance), 0.0);
  }
  record.planeSplit = low;
}

void main() {
  uint visible = linearGroup() * kGroupSize + gl_LocalInvocationIndex;
  if (visible >= COUNTERS.visibleCells) return;
  if ((FRAME.flags & kFlagOnlyPaired) != 0 && FRAME.tileCounts.v[visible] == 0) return;
  uvec4 cell = FRAME.visibleCells.v[checked(FRAME.order.v[visible], FRAME.visibleCapacity)];
  Chunk chunk = loadChunk(cell.x);
  vec4 siteRadius = siteRadiusOf(chunk, cell.y);
  Ball ball = ballOf(chunk, siteRadius);

  CellRecord record;
  record.ball = vec4(ball.centre, ball.radius);
  CellCode code = FRAME.chunks.v[chunk.index].code;
  BitCursor bits = cellBits(chunk.index, cell.y);
  record.face.w = takeDensity(code, bits);
  setFrame(takeOrientation(code, bits), record);
  record.tangent.w = 1.0 / ball.radius;
  record.bitangent.w = 0.0;
  record.solidBall = solidBallBytes(chunk.index, checked(cell.y, chunk.liveCount));
  expandPlanes(chunk, cell, siteRadius, record);
  FRAME.records.v[visible] = record;
}
