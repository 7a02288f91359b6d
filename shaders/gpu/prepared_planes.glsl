// The planes of a row as rays find them prepared (gpu/prepared_cells.glsl). They only tell which part of the row matters:
// the sites decide there, by the rules of gpu/descend.glsl, so that all steps are those of cells that are not prepared.
#ifndef FROTH_GPU_PREPARED_PLANES_GLSL
#define FROTH_GPU_PREPARED_PLANES_GLSL
#include "gpu/asset.glsl"
#include "foam/cell.h"

bool hasPlanes() { return FRAME.prepared != kPreparedNothing; }

vec4 preparedPlane(Chunk chunk, uint index) {
  return uintBitsToFloat(chunk.prepared.v[checked(index, chunk.neighbourCount)]);
}

// What the clearance from a prepared plane and sharedClearance() of the same two sites are off by together, of the
// lengths that enter them: 6 and a half units of float each (exitClearance() of foam/cell.h), and what is left for the
// rounding of this bound.
const float kPlaneRounding = 1e-6;

// Of where a ray meets a plane: a quotient's, and what walks take for a tie (kExitRounding).
const float kMeetingRounding = 1e-6;

float sizeOf(vec3 vector) { return abs(vector.x) + abs(vector.y) + abs(vector.z); }

// reach: the sizes of what the centre of the cell is the difference of.
float roundingOfClearance(vec4 plane, float reach) {
  float size = sizeOf(plane.xyz);
  return kPlaneRounding * (size * (reach + 2.0 * size) + abs(plane.w));
}

float clearanceOf(vec4 plane, vec3 centre) { return plane.w + dot(plane.xyz, centre); }

// The part of a cell's row through which a ray leaves it: the one neighbour whose plane it meets first, or none, or the
// whole row where rounding does not tell which is first.
uvec2 findExits(Chunk chunk, uvec2 row, vec3 centre, vec3 direction) {
  float reach = sizeOf(centre);
  uint first = row.y;
  float low = kInfinity, high = kInfinity;  // between which the ray meets the first plane,
  float nextLow = kInfinity;                // and from where on all others
  for (uint i = row.x; i < row.y; ++i) {
    vec4 plane = preparedPlane(chunk, i);
    float q = fixedDot(direction, plane.xyz);
    float clearance = clearanceOf(plane, centre);
    float rounding = roundingOfClearance(plane, reach);
    float inverse = 1.0 / q;
    float otherLow = q > 0.0 ? (clearance - rounding) * inverse : kInfinity;
    float otherHigh = q > 0.0 ? (clearance + rounding) * inverse : kInfinity;
    bool isFirst = otherHigh < high;
    nextLow = min(nextLow, isFirst ? low : otherLow);
    first = isFirst ? i : first;
    low = isFirst ? otherLow : low;
    high = isFirst ? otherHigh : high;
  }
  if (first == row.y) return nextLow < kInfinity ? row : uvec2(row.y, row.y);
  return nextLow > high + kMeetingRounding * abs(high) ? uvec2(first, first + 1) : row;
}

// The part of a cell's row to which the power of a point falls most: one neighbour, or none, or the whole row.
// centre: of the cell, as seen from the point.
uvec2 findFalls(Chunk chunk, uvec2 row, vec3 centre, float reach) {
  uint lowest = row.y;
  float low = -kInfinity, high = -kInfinity;  // between which it falls to that one,
  float nextHigh = -kInfinity;                // and at most to all others
  for (uint i = row.x; i < row.y; ++i) {
    vec4 plane = preparedPlane(chunk, i);
    float fall = -clearanceOf(plane, centre);
    float rounding = roundingOfClearance(plane, reach);
    bool isLowest = fall - rounding > low;
    nextHigh = max(nextHigh, isLowest ? high : fall + rounding);
    lowest = isLowest ? i : lowest;
    high = isLowest ? fall + rounding : high;
    low = isLowest ? fall - rounding : low;
  }
  if (max(high, nextHigh) < 0.0) return uvec2(row.y, row.y);
  return low > 0.0 && low > nextHigh ? uvec2(lowest, lowest + 1) : row;
}

#endif
