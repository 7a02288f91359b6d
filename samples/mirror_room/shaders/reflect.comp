#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "foam_rays.glsl"
#include "foam_light.glsl"

// The foam that mirrors and glossy meshes show: one ray per pixel of them.
void main() {
  ivec2 pixel = thisPixel();
  if (!isInImage(pixel)) return;
  Surface surface = surfaceAt(pixel);
  vec4 seen = vec4(0.0);
  if (isMirror(surface) || isGlossy(surface)) {
    vec3 along = surface.position / surface.distance;
    FrothRay ray = frothRay(surface.position, reflect(along, surface.normal));
    ray.tMin = kLift;
    if (isMirror(surface)) {
      // On the mirror's plane: a rasterizer interpolates depth with fewer digits, and an edge of the foam shows it.
      ray.origin = -room.mirror.w / dot(room.mirror.xyz, along) * along;
      // The mirrored camera sees the same colours, from where it stands; the rays end at the meshes that it sees.
      ray.direction = mirroredDirection(along);
      ray.apex = length(ray.origin);
      Surface beyond = mirroredSurfaceAt(pixel);
      if (beyond.isThere) ray.tMax = beyond.distance - ray.apex;
    }
    seen = foamAndMotes(ray);
  }
  imageStore(reflectionImage, pixel, seen);
}
