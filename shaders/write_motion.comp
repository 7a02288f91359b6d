// Where on the image of the frame before stood what a pixel shows, relative to the pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/hit_motion.glsl"

layout(set = 0, binding = 0, rg16f) uniform writeonly image2D motionImage;

const float kNowhere = 32768.0;  // [pixels] beyond any image
const float kLargestHalf = 65504.0;

vec2 motionOf(uvec2 pixel) {
  vec3 start, direction;
  if (HITS.hasPrevious == 0 || !rayOf(pixel, start, direction)) return vec2(0.0);
  Hit hit = loadHit(pixel);
  vec2 place;
  if (!placeBefore(start, direction, hit.distance, hit.instance, place)) return vec2(kNowhere);
  vec4 pixels = HITS.pixels;
  vec2 motion = place - (pixels.xy + vec2(pixel));
  bool arePanoramas = HITS.lensKind == kLensEquirectangular && HITS.previousKind == kLensEquirectangular;
  return arePanoramas ? shorterWay(motion) : motion;
}

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (!isInRegion(pixel)) return;
  vec4 pixels = HITS.pixels;
  vec2 motion = clamp(motionOf(pixel) * pixels.zw, -kLargestHalf, kLargestHalf);
  imageStore(motionImage, ivec2(pixel + uvec2(HITS.regionX, HITS.regionY)), vec4(motion, 0.0, 0.0));
}
