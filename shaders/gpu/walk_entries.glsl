// The grid over an instance's box that tells rays where to begin: for each of its boxes a cell that lies there,
// and which of its kPartsAlong^3 parts the balls of live cells meet.
#ifndef FROTH_GPU_WALK_ENTRIES_GLSL
#define FROTH_GPU_WALK_ENTRIES_GLSL
#include "gpu/asset.glsl"

const uint kPartsAlong = 4;
// [parts] What a ray may step over at a border, and what balls are larger by, so that it steps over none of them.
const float kPartSlack = 1e-3;
const float kPartGuard = 1e-2;
const uint kMostParts = 512;  // on the way of one ray

uint partsAlong() { return kPartsAlong * FRAME.entriesAlong; }

vec3 partsPerUnit() {
  vec4 size = FRAME.boxSize;
  return float(partsAlong()) / size.xyz;
}

// Where a point relative to the eye lies in the grid.
vec3 placeInParts(vec3 point) {
  vec4 low = FRAME.boxLow;
  return (point - low.xyz) * partsPerUnit();
}

uvec3 partAt(vec3 place) { return min(uvec3(max(place, vec3(0.0))), uvec3(partsAlong() - 1)); }

uint entryOfPart(uvec3 part) {
  uvec3 entry = part / kPartsAlong;
  return (entry.z * FRAME.entriesAlong + entry.y) * FRAME.entriesAlong + entry.x;
}

// Of the 64 of an entry.
uint bitOfPart(uvec3 part) {
  uvec3 inside = part % kPartsAlong;
  return (inside.z * kPartsAlong + inside.y) * kPartsAlong + inside.x;
}

// The first t from `t` on at which a ball may be, or tEnd.
float skipEmptyParts(vec3 origin, vec3 direction, float t, float tEnd) {
  vec3 place = placeInParts(origin);
  vec3 speed = direction * partsPerUnit();
  float slack = kPartSlack / max(abs(speed.x), max(abs(speed.y), abs(speed.z)));
  for (uint i = 0; i < kMostParts && t < tEnd; ++i) {
    uvec3 part = partAt(place + t * speed);
    uvec4 entry = FRAME.entries.v[entryOfPart(part)];
    uint bit = bitOfPart(part);
    if (((bit < 32 ? entry.z : entry.w) >> (bit % 32) & 1u) != 0) return t;
    uint size = (entry.z | entry.w) == 0 ? kPartsAlong : 1;
    uvec3 corner = part / size * size;
    float tExit = kInfinity;
    for (uint axis = 0; axis < 3; ++axis) {
      float border = float(corner[axis] + (speed[axis] > 0.0 ? size : 0));
      if (abs(speed[axis]) > 1e-20) tExit = min(tExit, (border - place[axis]) / speed[axis]);
    }
    t = max(t, tExit) + slack;
  }
  return min(t, tEnd);
}

#endif
