// Where walks of a view begin: at the least distance at which a ray of their tile can meet a ball.
#ifndef FROTH_GPU_WALK_BEGIN_GLSL
#define FROTH_GPU_WALK_BEGIN_GLSL
#include "gpu/pixels.glsl"
#include "gpu/view_rays.glsl"

// tile: its index. False: no ray of it meets a ball.
bool findWalkBegin(uint tile, out float distance) {
  uint complement = FRAME.tileLengths.v[tile];  // nearest_balls.comp
  distance = uintBitsToFloat(~complement);
  return complement != 0;
}

// Relative to the eye.
vec3 pointOnRay(vec3 ray, float distance) { return startOfRay(ray) + distance * directionOfRay(ray); }

#endif
