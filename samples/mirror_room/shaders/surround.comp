#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "foam_rays.glsl"
#include "hemisphere.glsl"

// Surrounding light that reaches the meshes past the foam, by a few short rays. Sixteen neighbours with rays share one
// spread of directions, and light_room.comp takes their mean.
float surroundAt(Surface surface, uint place) {
  if (!surface.isThere) return 0.0;
  float sum = 0.0;
  for (uint i = 0; i < kSurroundRays; ++i) {
    vec3 direction = spreadDirection(surface.normal, 16u * i + place, 16u * kSurroundRays);
    sum += throughFoam(surface.position, direction, room.numbers.y);
  }
  return sum / float(kSurroundRays);
}

void main() {
  ivec2 pixel = pixelWithRay();
  if (!isInImage(pixel)) return;
  Shown shown = shownAt(pixel);
  imageStore(surroundImage, pixel, shareOf(shown, surroundAt(shown.surface, placeInBlock(thisPixel()))));
}
