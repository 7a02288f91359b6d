#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "foam_rays.glsl"
#include "between_rays.glsl"

// Sun that reaches the meshes, past other meshes and through the foam: one ray per surface that it shines on.
float sunAt(Surface surface) {
  if (!surface.isThere || dot(surface.normal, room.toSun.xyz) <= 0.0) return 0.0;
  float past = sunPastMeshes(surface.position, surface.normal);
  return past > 0.0 ? past * throughFoam(surface.position, room.toSun.xyz, FROTH_INFINITY) : 0.0;
}

bool isFromAround(ivec2 pixel, Shown shown, out vec4 mean) {
  float count = 0.0;
  mean = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 other = pixelAround(pixel, i);
    if (!isInImage(other) || !showsSame(shown, shownAt(other))) continue;
    mean += imageLoad(sunlightImage, other);
    count += 1.0;
  }
  mean /= max(count, 1.0);
  return count > 0.0;
}

void main() {
  ivec2 pixel = pixelOfThread();
  if (!isMine(pixel)) return;
  Shown shown = shownAt(pixel);
  vec4 light;
  bool isTaken = isBetween && shown.surface.isThere && isFromAround(pixel, shown, light);
  if (!isTaken) light = shareOf(shown, sunAt(shown.surface));
  imageStore(sunlightImage, pixel, light);
}
