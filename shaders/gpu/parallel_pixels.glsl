// Balls against the parallel rays of an orthographic view.
#ifndef FROTH_GPU_PARALLEL_PIXELS_GLSL
#define FROTH_GPU_PARALLEL_PIXELS_GLSL
#include "gpu/frame.glsl"
#include "foam/rays.h"

// (u, v) of the centre of a pixel of the region. rayX runs along u.
vec2 placeOfPixel(vec2 pixel) {
  vec4 stepX = FRAME.rayX, stepY = FRAME.rayY;  // whole loads: see cull_cells.comp
  return (pixel.x - stepX.w) * stepX.xy + (pixel.y - stepY.w) * stepY.xy;
}

// Pixel coordinates of a ball's centre, and how far its image reaches along columns and rows. reach.x < 0: the ball
// lies behind the camera's plane. Never smaller than the image.
void ballOnPixels(vec3 centre, float exactRadius, out vec2 middle, out vec2 reach) {
  float radius = guardedRadius(centre, exactRadius);
  vec4 stepX = FRAME.rayX, stepY = FRAME.rayY;  // whole loads: see cull_cells.comp
  vec2 place = vec2(dot(centre, FRAME.lensFirst.xyz), dot(centre, FRAME.lensSecond.xyz));
  float shear = stepY.x / stepY.y;
  middle = vec2((place.x - place.y * shear) / stepX.x + stepX.w, place.y / stepY.y + stepY.w);
  reach = radius * abs(vec2(sqrt(1.0 + shear * shear) / stepX.x, 1.0 / stepY.y));
  if (!(dot(centre, FRAME.forward.xyz) > -radius)) reach = vec2(-1.0);
}

bool parallelPixelsMeetBall(vec3 centre, float radius, vec2 first, vec2 last) {
  vec2 middle, reach;
  ballOnPixels(centre, radius, middle, reach);
  return reach.x >= 0.0 && all(lessThanEqual(middle - reach, last)) && all(greaterThanEqual(middle + reach, first));
}

#endif
