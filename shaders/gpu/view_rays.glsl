// What tells a ray from the others of its view: where all start at the eye its unit direction, where all are parallel
// the place (u, v) on the camera's plane where it starts, as (u, v, 1). Either way its dot product with a cell's plane
// (gpu/eye_planes.glsl) is the nearness of the point where they meet, which falls with the distance along the ray.
#ifndef FROTH_GPU_VIEW_RAYS_GLSL
#define FROTH_GPU_VIEW_RAYS_GLSL
#include "gpu/frame.glsl"
#include "foam/cell.h"

const bool isParallel = lensClass == kLensClassOrthographic;

float nearnessAt(float t) { return isParallel ? -t : 1.0 / t; }

// Of the point where a ray meets a plane. The same bits wherever a walk finds the plane, in a record's row or by
// itself: drivers fuse the two texts in different ways where they may.
float nearnessOf(vec3 plane, vec3 ray) {
  precise float nearness = fma(plane.x, ray.x, fma(plane.y, ray.y, plane.z * ray.z));
  return nearness;
}

float distanceAt(float nearness) { return isParallel ? -nearness : 1.0 / nearness; }

vec3 directionOfRay(vec3 ray) { return isParallel ? FRAME.forward.xyz : ray; }

// Relative to the eye.
vec3 startOfRay(vec3 ray) {
  return isParallel ? ray.x * FRAME.lensFirst.xyz + ray.y * FRAME.lensSecond.xyz : vec3(0.0);
}

// A point's centre as seen from the ray's start.
vec3 fromStart(vec3 ray, vec3 centre) { return isParallel ? centre - startOfRay(ray) : centre; }

bool meetBall(vec4 ball, vec3 ray, out float tNear, out float tFar) {
  return intersectBall(fromStart(ray, ball.xyz), ball.w, directionOfRay(ray), tNear, tFar);
}

// The least distance along any ray at which it can meet the ball.
float distanceToBall(vec3 centre, float radius) {
  return max((isParallel ? dot(centre, FRAME.forward.xyz) : length(centre)) - radius, 0.0);
}

#endif
