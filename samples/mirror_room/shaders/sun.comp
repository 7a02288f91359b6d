#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "foam_rays.glsl"

// Sun that reaches the meshes, past other meshes and through the foam: one ray per surface that it shines on.
float sunAt(Surface surface) {
  if (!surface.isThere || dot(surface.normal, room.toSun.xyz) <= 0.0) return 0.0;
  float past = sunPastMeshes(surface.position, surface.normal);
  return past > 0.0 ? past * throughFoam(surface.position, room.toSun.xyz, FROTH_INFINITY) : 0.0;
}

void main() {
  ivec2 pixel = pixelWithRay();
  if (!isInImage(pixel)) return;
  Shown shown = shownAt(pixel);
  imageStore(sunlightImage, pixel, shareOf(shown, sunAt(shown.surface)));
}
