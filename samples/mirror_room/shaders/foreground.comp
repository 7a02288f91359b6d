#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "foam_rays.glsl"
#include "foam_light.glsl"

// Foam and motes before the meshes. Where there is no mote the rasterizer has drawn them already.
vec4 foreground(ivec2 pixel) {
  vec3 along = normalize(rayOf(pixel));
  FrothRay ray = frothRay(vec3(0.0), along);
  ray.tMax = surfaceAt(pixel).distance;
  Mote mote;
  if (findMote(ray, 0.0, mote)) return foamAndMotes(ray);
  vec4 foam = texelFetch(foamColourImage, pixel, 0);
  float distance = texelFetch(foamDistanceImage, pixel, 0).x;
  vec3 normal = texelFetch(foamNormalImage, pixel, 0).xyz;
  if (distance < kFar && normal != vec3(0.0)) foam.rgb *= caughtShadow(distance * along, normalize(normal));
  return foam;
}

void main() {
  ivec2 pixel = thisPixel();
  if (isInImage(pixel)) imageStore(resultImage, pixel, foreground(pixel));
}
