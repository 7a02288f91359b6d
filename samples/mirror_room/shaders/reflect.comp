#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "foam_rays.glsl"
#include "between_rays.glsl"
#include "foam_light.glsl"

bool isReflecting(Surface surface) { return isMirror(surface) || isGlossy(surface); }

// The foam that a mirror or a glossy mesh shows, by a ray.
vec4 reflection(ivec2 pixel, Surface surface) {
  vec3 along = surface.position / surface.distance;
  FrothRay ray = frothRay(surface.position, reflect(along, surface.normal));
  ray.tMin = kLift;
  if (room.counts.w != 0) ray.colours = FROTH_COLOURS_BASE;
  if (isMirror(surface)) {
    // On the mirror's plane: a rasterizer interpolates depth with fewer digits, and an edge of the foam shows it.
    ray.origin = -room.mirror.w / dot(room.mirror.xyz, along) * along;
    // The mirrored camera sees the same colours, from where it stands; the rays end at the meshes that it sees.
    ray.direction = mirroredDirection(along);
    ray.apex = length(ray.origin);
    Surface beyond = mirroredSurfaceAt(pixel);
    if (beyond.isThere) ray.tMax = beyond.distance - ray.apex;
  }
  return foamAndMotes(ray);
}

bool isFromAround(ivec2 pixel, Surface surface, out vec4 mean) {
  float count = 0.0;
  mean = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 other = pixelAround(pixel, i);
    if (!isInImage(other) || !isSameSurface(surface, surfaceAt(other))) continue;
    mean += imageLoad(reflectionImage, other);
    count += 1.0;
  }
  mean /= max(count, 1.0);
  return count > 0.0;
}

void main() {
  ivec2 pixel = pixelOfThread();
  if (!isMine(pixel)) return;
  Surface surface = surfaceAt(pixel);
  vec4 seen = vec4(0.0);
  if (isReflecting(surface) && !(isBetween && isFromAround(pixel, surface, seen))) seen = reflection(pixel, surface);
  imageStore(reflectionImage, pixel, seen);
}
