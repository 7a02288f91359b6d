// Where on the image of the frame before stood what a pixel shows, relative to the pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/hit_pass.glsl"
#include "foam/lens.h"

layout(set = 0, binding = 0, rg16f) uniform writeonly image2D motionImage;

const float kNowhere = 32768.0;  // [pixels] beyond any image
const float kLargestHalf = 65504.0;

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

vec2 motionOf(uvec2 pixel) {
  vec3 start, direction;
  if (HITS.hasPrevious == 0 || !rayOf(pixel, start, direction)) return vec2(0.0);
  Hit hit = loadHit(pixel);
  vec4 rows[3];
  vec4 point;
  if (isinf(hit.distance)) {  // the background: far away, or along parallel rays where they start
    point = HITS.lensKind == kLensOrthographic ? vec4(start, 1.0) : vec4(direction, 0.0);
    for (int i = 0; i < 3; ++i) rows[i] = HITS.backgroundRows[i];
  } else {
    point = vec4(start + hit.distance * direction, 1.0);
    for (int i = 0; i < 3; ++i) rows[i] = HITS.instances.v[hit.instance].rows[i];
  }
  vec2 place;
  if (!previousPlace(vec3(dot(rows[0], point), dot(rows[1], point), dot(rows[2], point)), place)) return vec2(kNowhere);
  vec4 pixels = HITS.pixels;
  vec2 motion = place - (pixels.xy + vec2(pixel));
  if (HITS.lensKind == kLensEquirectangular && HITS.previousKind == kLensEquirectangular) {
    float turn = 2.0 * lensPi(1.0) * HITS.previousPixels.x;
    motion.x -= turn * round(motion.x / turn);  // the shorter way around
  }
  return motion;
}

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (!isInRegion(pixel)) return;
  vec4 pixels = HITS.pixels;
  vec2 motion = clamp(motionOf(pixel) * pixels.zw, -kLargestHalf, kLargestHalf);
  imageStore(motionImage, ivec2(pixel + uvec2(HITS.regionX, HITS.regionY)), vec4(motion, 0.0, 0.0));
}
