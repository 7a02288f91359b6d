// Rays against the row of eye planes of a visible cell.
#ifndef FROTH_GPU_CLIP_PLANES_GLSL
#define FROTH_GPU_CLIP_PLANES_GLSL
#include "gpu/shade_hit.glsl"

// The parts of the intervals on the cell's side of all its radical planes. Returns whether any is left.
bool clipByPlanes(Shading shading, uvec3 row, vec3 rays[kRays], inout Segment segments[kRays]) {
  float far[kRays], near[kRays];  // nearness of where the intervals end
  for (uint r = 0; r < kRays; ++r) {
    far[r] = nearnessAt(segments[r].tFar);
    near[r] = kInfinity;
  }
  for (uint i = row.x; i < row.y; ++i) {
    vec3 plane = shading.planes.v[checked(i, FRAME.planeCapacity)].xyz;
    for (uint r = 0; r < kRays; ++r) far[r] = max(far[r], dot(plane, rays[r]));
  }
  for (uint i = row.y; i < row.z; ++i) {
    vec3 plane = shading.planes.v[checked(i, FRAME.planeCapacity)].xyz;
    for (uint r = 0; r < kRays; ++r) near[r] = min(near[r], dot(plane, rays[r]));
  }
  bool isAny = false;
  for (uint r = 0; r < kRays; ++r) {
    if (isEmpty(segments[r])) continue;
    countWork(kWorkPlanes, row.z - row.x);
    segments[r].tFar = isParallel || near[r] > 0.0 ? distanceAt(far[r]) : 0.0;
    segments[r].tNear = max(segments[r].tNear, distanceAt(near[r]));
    isAny = isAny || !isEmpty(segments[r]);
  }
  return isAny;
}

#endif
