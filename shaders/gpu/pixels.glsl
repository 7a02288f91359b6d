// Rays of the region's pixels.
#ifndef FROTH_GPU_PIXELS_GLSL
#define FROTH_GPU_PIXELS_GLSL
#include "gpu/frame.glsl"
#include "gpu/parallel_pixels.glsl"
#include "gpu/pixel_cones.glsl"
#include "foam/rays.h"

// Bounds in pixels are trusted to this much: float rounding at 16384 pixels, with a margin.
const float kPixelGuard = 0.05;

// Of a pinhole, through the centre of a pixel of the region; not normalized.
vec3 pixelRay(vec2 pixel) {
  // Whole loads: see cull_cells.comp.
  vec4 middle = FRAME.rayOrigin, stepX = FRAME.rayX, stepY = FRAME.rayY;
  return middle.xyz + (pixel.x - stepX.w) * stepX.xyz + (pixel.y - stepY.w) * stepY.xyz;
}

// The ray of a pixel of the region (gpu/view_rays.glsl); 0: it sees nothing. Beside the region: anything.
vec3 rayOf(uvec2 pixel) {
  if (lensClass == kLensClassPinhole) return normalize(pixelRay(vec2(pixel)));
  if (lensClass == kLensClassOrthographic) return vec3(placeOfPixel(vec2(pixel)), 1.0);
  uvec2 place = min(pixel, uvec2(FRAME.regionWidth, FRAME.regionHeight) - 1);
  return FRAME.rays.v[place.y * FRAME.regionWidth + place.x].xyz;
}

bool seesNothing(vec3 ray) { return lensClass == kLensClassMapped && ray == vec3(0.0); }

// Whether a ray of the block of `size` x `size` pixels, cut to the region, can meet the ball. A guard around the block
// keeps the rectangle from vanishing where it holds one pixel.
bool pixelsMeetBall(vec3 centre, float radius, uvec2 firstPixel, uint size) {
  if (lensClass == kLensClassMapped) return conesMeetBall(centre, radius, firstPixel, size);
  uvec2 lastPixel = min(firstPixel + size, uvec2(FRAME.regionWidth, FRAME.regionHeight)) - 1;
  vec2 first = vec2(firstPixel) - kPixelGuard;
  vec2 extent = vec2(lastPixel - firstPixel) + 2.0 * kPixelGuard;
  if (lensClass == kLensClassOrthographic) return parallelPixelsMeetBall(centre, radius, first, first + extent);
  return rectangleMeetsBall(centre, radius, pixelRay(first), FRAME.rayX.xyz * extent.x, FRAME.rayY.xyz * extent.y);
}

#endif
