#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "foam_rays.glsl"
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

void main() {
  ivec2 pixel = pixelWithRay();
  if (!isInImage(pixel)) return;
  Surface surface = surfaceAt(pixel);
  imageStore(reflectionImage, pixel, isReflecting(surface) ? reflection(pixel, surface) : vec4(0.0));
}
