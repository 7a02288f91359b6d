// The box around an instance's live cells.
#ifndef FROTH_GPU_BOX_GLSL
#define FROTH_GPU_BOX_GLSL
#include "gpu/view_rays.glsl"

const float kLeastSlope = 1e-30;  // steeper than any ray that leaves a box: infinities stay out of what follows

// Where the ray is in the box of the instance at hand, behind its start; empty: nowhere.
Segment insideBox(vec3 ray) {
  vec3 direction = directionOfRay(ray), start = startOfRay(ray);
  vec3 slope = mix(max(direction, kLeastSlope), min(direction, -kLeastSlope), lessThan(direction, vec3(0.0)));
  vec3 low = (FRAME.boxLow.xyz - start) / slope, high = (FRAME.boxHigh.xyz - start) / slope;
  vec3 near = min(low, high), far = max(low, high);
  return Segment(max(max(near.x, 0.0), max(near.y, near.z)), min(far.x, min(far.y, far.z)));
}

#endif
