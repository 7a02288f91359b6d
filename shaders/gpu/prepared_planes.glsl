// The planes of a row as rays find them prepared (gpu/prepared_cells.glsl): toNeighbour, and radicalOffset less what does
// not depend on the ray of what it is rounded by. They only tell which part of the row matters: the sites decide there,
// by the rules of gpu/descend.glsl, so that all steps are those of cells that are not prepared.
#ifndef FROTH_GPU_PREPARED_PLANES_GLSL
#define FROTH_GPU_PREPARED_PLANES_GLSL
#include "gpu/asset.glsl"
#include "foam/cell.h"

bool hasPlanes() { return FROTH_WALK_PREPARED != kPreparedNothing; }

vec4 preparedPlane(Chunk chunk, uint index) {
  return uintBitsToFloat(chunk.prepared.v[checked(index, chunk.neighbourCount)]);
}

// What the clearance from a prepared plane and sharedClearance() of the same two sites are off by together, of the
// lengths that enter them: 6 and a half units of float each (exitClearance() of foam/cell.h), and what is left for the
// rounding of this bound.
const float kPlaneRounding = 1e-6;

// Of where a ray meets a plane: a quotient's, and what walks take for a tie (kExitRounding).
const float kMeetingRounding = 1e-6;

const uint kPlanesAtOnce = 4;  // that are read before they are asked

float sizeOf(vec3 vector) { return abs(vector.x) + abs(vector.y) + abs(vector.z); }

// reach: the sizes of what the centre of the cell is the difference of.
float roundingOfClearance(vec4 plane, float reach) {
  float size = sizeOf(plane.xyz);
  return kPlaneRounding * (size * (reach + 2.0 * size) + abs(plane.w));
}

vec4 preparePlane(vec3 toNeighbour, float offset) {
  return vec4(toNeighbour, offset - roundingOfClearance(vec4(toNeighbour, offset), 0.0));
}

float leastClearanceOf(vec4 plane, vec3 centre, float reach) {
  return plane.w + dot(plane.xyz, centre) - dot(abs(plane.xyz), vec3(kPlaneRounding * reach));
}

float mostClearanceOf(vec4 plane, vec3 centre, float reach) {
  return leastClearanceOf(plane, centre, reach) + 2.0 * roundingOfClearance(plane, reach);
}

// The part of a cell's row through which a ray leaves it: the one neighbour whose plane it meets first, or none, or the
// whole row where rounding does not tell which is first.
uvec2 findExits(Chunk chunk, uvec2 row, vec3 centre, vec3 direction) {
  float reach = sizeOf(centre);
  uint first = row.y;
  float low = kInfinity, nextLow = kInfinity;  // before which the ray meets not the first plane, and none of the others
  for (uint i = row.x; i < row.y; i += kPlanesAtOnce) {
    vec4 planes[kPlanesAtOnce];
    for (uint k = 0; k < kPlanesAtOnce; ++k) planes[k] = preparedPlane(chunk, min(i + k, row.y - 1));
    for (uint k = 0; k < kPlanesAtOnce; ++k) {
      float q = fixedDot(direction, planes[k].xyz);
      float clearance = leastClearanceOf(planes[k], centre, reach);
      float otherLow = q > 0.0 && i + k < row.y ? clearance / q : kInfinity;
      nextLow = min(nextLow, max(low, otherLow));
      first = otherLow < low ? i + k : first;
      low = min(low, otherLow);
    }
  }
  if (first == row.y) return uvec2(row.y, row.y);
  vec4 plane = preparedPlane(chunk, first);
  float high = mostClearanceOf(plane, centre, reach) / fixedDot(direction, plane.xyz);
  return nextLow > high + kMeetingRounding * abs(high) ? uvec2(first, first + 1) : row;
}

// The part of a cell's row to which the power of a point falls most: one neighbour, or none, or the whole row.
// centre: of the cell, as seen from the point.
uvec2 findFalls(Chunk chunk, uvec2 row, vec3 centre, float reach) {
  uint lowest = row.y;
  float high = -kInfinity, nextHigh = -kInfinity;  // by how much it falls at most to that one, and to the others
  for (uint i = row.x; i < row.y; i += kPlanesAtOnce) {
    vec4 planes[kPlanesAtOnce];
    for (uint k = 0; k < kPlanesAtOnce; ++k) planes[k] = preparedPlane(chunk, min(i + k, row.y - 1));
    for (uint k = 0; k < kPlanesAtOnce; ++k) {
      float otherHigh = i + k < row.y ? -leastClearanceOf(planes[k], centre, reach) : -kInfinity;
      nextHigh = max(nextHigh, min(high, otherHigh));
      lowest = otherHigh > high ? i + k : lowest;
      high = max(high, otherHigh);
    }
  }
  if (high < 0.0 || lowest == row.y) return uvec2(row.y, row.y);
  vec4 plane = preparedPlane(chunk, lowest);
  float low = -mostClearanceOf(plane, centre, reach);
  return low > 0.0 && low > nextHigh ? uvec2(lowest, lowest + 1) : row;
}

#endif
