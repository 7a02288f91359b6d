// Which part of a pixel its motion does not explain: of its four quarters (foam/quarters.h), by where on the image of the
// frame before each stood, beside where the pixel's point did.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/hit_motion.glsl"
#include "foam/quarters.h"

layout(set = 0, binding = 0, r8) uniform writeonly image2D reactiveImage;

float reactiveOf(uvec2 pixel) {
  if (HITS.hasPrevious == 0) return 1.0;
  vec3 start, direction;
  if (!rayOf(pixel, start, direction)) return 0.0;
  Hit hit = loadHit(pixel);
  vec2 shown;
  bool isShown = placeBefore(start, direction, hit.distance, hit.instance, shown);
  uvec4 quarters = HITS.quarters.v[pixel.y * HITS.regionWidth + pixel.x];
  float unexplained = 0.0;
  for (int i = 0; i < 4; ++i) {
    float distance = uintBitsToFloat(quarters[i] & ~kQuarterPartMask);
    vec2 place;
    bool isSeen = placeBefore(start, direction, distance, quarters[i] & kQuarterPartMask, place);
    vec2 apart = place - shown;
    if (HITS.previousKind == kLensEquirectangular) apart = shorterWay(apart);
    unexplained += isSeen && isShown ? unexplainedPart(length(apart)) : float(isSeen != isShown);
  }
  return 0.25 * unexplained;
}

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (!isInRegion(pixel)) return;
  imageStore(reactiveImage, ivec2(pixel + uvec2(HITS.regionX, HITS.regionY)), vec4(reactiveOf(pixel)));
}
