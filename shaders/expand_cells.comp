// What every ray through the eye shares of a visible cell: its frame, and its radical planes as eye planes, those that
// only lower tFar first. Several threads per cell share its planes.
//
// A walk leaves a cell through a plane of the first kind: the eye lies on the cell's side of it. Each has a link to the
// cell behind it: where its record is, or kUnlisted and its site.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/cell_bits.glsl"
#include "gpu/eye_planes.glsl"

layout(local_size_x = kGroupSize) in;

shared uint farMasks[kGroupSize / kRasterLanes];  // which of the planes at hand lower tFar
shared uint mostPlanes;

uint linkTo(Chunk chunk, uint site) {
  uint slot = slotOfCell(cellOfSite(chunk, site));
  return slot == kNoCell ? kUnlisted | site : slot;
}

// Planes of the first kind from the begin of the cell's space up, the others from its end down; returns where they
// meet.
uint expandPlanes(Chunk chunk, uvec4 cell, vec4 siteRadius) {
  uint lanes = lanesPerCell();
  uint lane = gl_LocalInvocationIndex % lanes;
  uint group = gl_LocalInvocationIndex / lanes;
  uint row = cell.w > 0 ? neighbourRow(chunk, cell.y).x : 0;
  uint low = cell.z;
  uint high = cell.z + cell.w;
  for (uint first = 0; first < mostPlanes; first += lanes) {
    if (lane == 0) farMasks[group] = 0;
    barrier();
    bool isPlane = first + lane < cell.w;
    bool isFar = false;
    vec4 plane = vec4(0.0);
    if (isPlane) {
      uint other = neighbourAt(chunk, row + first + lane);
      plane.xyz = eyePlaneTo(chunk, siteRadius, siteRadiusOf(chunk, other), isFar);
      if (isFar && isWalk()) plane.w = uintBitsToFloat(linkTo(chunk, other));
    }
    if (isFar) atomicOr(farMasks[group], 1u << lane);
    barrier();
    uint mask = farMasks[group];
    uint farBefore = bitCount(mask & ((1u << lane) - 1));
    uint place = isFar ? low + farBefore : high - 1 - (lane - farBefore);
    if (isPlane) FRAME.planes.v[checked(place, FRAME.planeCapacity)] = plane;
    uint farPlanes = bitCount(mask);
    low += farPlanes;
    high -= min(cell.w - min(first, cell.w), lanes) - farPlanes;
    barrier();
  }
  return low;
}

void main() {
  uint slot = (linearGroup() * kGroupSize + gl_LocalInvocationIndex) / lanesPerCell();
  bool isCell = slot < COUNTERS.visibleCells;
  uvec4 cell = isCell ? FRAME.visibleCells.v[slot] : uvec4(firstCell(), 0, 0);
  if (gl_LocalInvocationIndex == 0) mostPlanes = 0;
  barrier();
  atomicMax(mostPlanes, cell.w);
  barrier();

  Chunk chunk = loadChunk(cell.x);
  vec4 siteRadius = siteRadiusOf(chunk, cell.y);
  uint split = expandPlanes(chunk, cell, siteRadius);
  if (!isCell || gl_LocalInvocationIndex % lanesPerCell() != 0) return;
  Ball ball = ballOf(chunk, siteRadius);
  CellRecord record;
  record.planeBegin = cell.z;
  record.planeSplit = split;
  record.planeEnd = cell.z + cell.w;
  record.ball = vec4(ball.centre, 0.0);
  if (cell.y < chunk.liveCount) {
    record.ball.w = ball.radius;
    CellCode code = FRAME.chunks.v[chunk.index].code;
    BitCursor bits = cellBits(chunk.index, cell.y);
    record.face.w = takeDensity(code, bits);
    Frame frame = takeFrame(code, bits);
    record.face.xyz = frame.normal / ball.radius;
    vec3 tangent = frame.tangent / ball.radius;
    vec3 bitangent = frame.bitangent / ball.radius;
    record.tangent = vec4(tangent, dot(tangent, ball.centre));
    record.bitangent = vec4(bitangent, dot(bitangent, ball.centre));
    record.solidBall = solidBallBytes(chunk.index, cell.y);
  }
  FRAME.records.v[slot] = record;
}
