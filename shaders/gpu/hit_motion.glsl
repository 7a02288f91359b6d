// Where on the image of the frame before stood what a ray meets.
#ifndef FROTH_GPU_HIT_MOTION_GLSL
#define FROTH_GPU_HIT_MOTION_GLSL
#include "gpu/hit_pass.glsl"
#include "foam/lens.h"

// The ray of a pixel from `start` along the unit vector `direction`; false: there is none.
bool rayOf(uvec2 pixel, out vec3 start, out vec3 direction) {
  int kind = int(HITS.lensKind);
  vec4 lensPlace = HITS.lensPoint;
  vec4 stepX = HITS.rayX, stepY = HITS.rayY;
  vec3 along = HITS.rayOrigin.xyz + (float(pixel.x) - stepX.w) * stepX.xyz + (float(pixel.y) - stepY.w) * stepY.xyz;
  start = vec3(0.0);
  direction = HITS.forward.xyz;
  if (kind == kLensOrthographic) {
    start = along.x * HITS.lensFirst.xyz + along.y * HITS.lensSecond.xyz;
    return true;
  }
  if (kind != kLensPinhole) {
    vec3 seen;
    vec2 point = lensPlace.xy + vec2(pixel) * lensPlace.zw;
    if (!lensRay(kind, point, HITS.lensFirst, HITS.lensSecond, HITS.lensRange, seen)) return false;
    along = seen.x * stepX.xyz + seen.y * stepY.xyz + seen.z * HITS.rayOrigin.xyz;
  }
  direction = normalize(along);
  return true;
}

// In pixels; false: nowhere on any image.
bool previousPlace(vec3 seen, out vec2 place) {
  int kind = int(HITS.previousKind);
  vec4 pixels = HITS.previousPixels;
  if (kind == kLensPinhole) {
    place = seen.xy / seen.z;
    return seen.z > 0.0;
  }
  vec2 point;
  bool isSeen = lensPoint(kind, seen, HITS.previousFirst, HITS.previousSecond, HITS.previousRange, point);
  place = pixels.zw + point * pixels.xy;
  return isSeen;
}

// The place of the point at `distance`, which moves with `instance`; +inf: of the background, far away, or along parallel
// rays where they start.
bool placeBefore(vec3 start, vec3 direction, float distance, uint instance, out vec2 place) {
  vec4 rows[3];
  vec4 point;
  if (isinf(distance)) {
    point = HITS.lensKind == kLensOrthographic ? vec4(start, 1.0) : vec4(direction, 0.0);
    for (int i = 0; i < 3; ++i) rows[i] = HITS.backgroundRows[i];
  } else {
    point = vec4(start + distance * direction, 1.0);
    for (int i = 0; i < 3; ++i) rows[i] = HITS.instances.v[instance].rows[i];
  }
  return previousPlace(vec3(dot(rows[0], point), dot(rows[1], point), dot(rows[2], point)), place);
}

// Around a panorama of the frame before.
vec2 shorterWay(vec2 way) {
  float turn = 2.0 * lensPi(1.0) * HITS.previousPixels.x;
  return vec2(way.x - turn * round(way.x / turn), way.y);
}

#endif
