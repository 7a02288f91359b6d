// Distances along rays to and from the caller's device depth, which his projection defines. With lenses that are no
// projection it is the distance itself, in world units.
#ifndef FROTH_GPU_DEVICE_DEPTH_GLSL
#define FROTH_GPU_DEVICE_DEPTH_GLSL
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/view_rays.glsl"

layout(set = 0, binding = kBindingSceneDepth) uniform texture2D sceneDepth;

// Numerator and denominator of device depth, from 0 to 1, at distance t along a ray: x + t y each.
vec2 depthAlong(vec3 ray, vec4 row) {
  return vec2(dot(row.xyz, startOfRay(ray)) + row.w, dot(row.xyz, directionOfRay(ray)));
}

// Where the scene stops the ray of a pixel of the region; kInfinity: nowhere.
float sceneDistance(uvec2 pixel, vec3 ray) {
  if (!isFull || (FRAME.flags & kFlagSceneDepth) == 0) return kInfinity;
  float depth = texelFetch(sceneDepth, ivec2(pixel + uvec2(FRAME.regionX, FRAME.regionY)), 0).x;
  if (lensClass == kLensClassMapped) return depth / FRAME.scale;
  float unit = (depth - FRAME.depthRange.x) / (FRAME.depthRange.y - FRAME.depthRange.x);
  bool isAtFarEnd = FRAME.depthRange.z > 0.5 ? unit >= 1.0 : unit <= 0.0;
  vec2 above = depthAlong(ray, FRAME.depthRow);
  vec2 below = depthAlong(ray, FRAME.depthScale);
  float t = (unit * below.x - above.x) / (above.y - unit * below.y);
  // Parallel rays start in the middle of what the camera sees: what lies there or before it, but for rounding, hides
  // all of them.
  if (lensClass == kLensClassOrthographic && t < 0.0) t = 0.0;
  return isAtFarEnd || !(t >= 0.0) ? kInfinity : t;
}

// t: kInfinity gives the far end.
float deviceDepthAt(vec3 ray, float t) {
  if (lensClass == kLensClassMapped) return t * FRAME.scale;
  vec2 above = depthAlong(ray, FRAME.depthRow);
  vec2 below = depthAlong(ray, FRAME.depthScale);
  float unit = isinf(t) ? FRAME.depthRange.z : clamp((above.x + t * above.y) / (below.x + t * below.y), 0.0, 1.0);
  return mix(FRAME.depthRange.x, FRAME.depthRange.y, unit);
}

#endif
