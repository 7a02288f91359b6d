// The caller's images. FROTH_COLOUR_FORMAT is rgba16f or rgba32f; images that are not wanted are placeholders, untouched.
#ifndef FROTH_GPU_OUTPUTS_GLSL
#define FROTH_GPU_OUTPUTS_GLSL
#include "gpu/frame.glsl"
#include "foam/colour.h"

layout(set = 0, binding = kBindingColour, FROTH_COLOUR_FORMAT) uniform writeonly image2D colourImage;
layout(set = 0, binding = kBindingDistance, r32f) uniform writeonly image2D distanceImage;
layout(set = 0, binding = kBindingNormal, rgba16f) uniform writeonly image2D normalImage;
layout(set = 0, binding = kBindingDepth, r32f) uniform writeonly image2D depthImage;

// Workgroups at the right and lower border hang over it.
bool isInRegion(uvec2 pixel) { return pixel.x < FRAME.regionWidth && pixel.y < FRAME.regionHeight; }

// A vector of the asset's axes.
vec3 inWorld(vec3 vector) {
  return vec3(dot(FRAME.worldX.xyz, vector), dot(FRAME.worldY.xyz, vector), dot(FRAME.worldZ.xyz, vector));
}

// `pixel` counts from the region's corner; `colour` is display-coded, distance and normal in the world's units and axes.
void writePixel(uvec2 pixel, vec3 colour, float coverage, float distance, vec3 normal, float deviceDepth) {
  ivec2 place = ivec2(pixel + uvec2(FRAME.regionX, FRAME.regionY));
  if ((FRAME.flags & kFlagColour) != 0) {
    vec3 coded = (FRAME.flags & kFlagDisplayCoded) != 0 ? colour : linearPremultiplied(colour, coverage);
    imageStore(colourImage, place, vec4(coded, coverage));
  }
  if ((FRAME.flags & kFlagDistance) != 0) imageStore(distanceImage, place, vec4(distance));
  if ((FRAME.flags & kFlagNormal) != 0) imageStore(normalImage, place, vec4(normal, 0.0));
  if ((FRAME.flags & kFlagDepth) != 0) imageStore(depthImage, place, vec4(deviceDepth));
}

#endif
