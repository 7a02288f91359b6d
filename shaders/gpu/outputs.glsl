// The caller's images. FROTH_COLOUR_FORMAT is rgba16f or rgba32f; images that are not wanted are placeholders,
// untouched.
#ifndef FROTH_GPU_OUTPUTS_GLSL
#define FROTH_GPU_OUTPUTS_GLSL
#include "gpu/frame.glsl"
#include "foam/colour.h"
#include "foam/tone.h"

layout(set = 0, binding = kBindingColour, FROTH_COLOUR_FORMAT) uniform writeonly image2D colourImage;
layout(set = 0, binding = kBindingDistance, r32f) uniform writeonly image2D distanceImage;
layout(set = 0, binding = kBindingNormal, rgba16f) uniform writeonly image2D normalImage;
layout(set = 0, binding = kBindingDepth, r32f) uniform writeonly image2D depthImage;

// Workgroups at the right and lower border hang over it.
bool isInRegion(uvec2 pixel) { return pixel.x < FRAME.regionWidth && pixel.y < FRAME.regionHeight; }

// What the colour image takes of a display-coded colour; both premultiplied.
vec3 outputColour(vec3 colour, float coverage, float exposure) {
  bool isCoded = (FRAME.flags & kFlagDisplayCoded) != 0;
  if (isCoded && exposure == 1.0) return colour;
  vec3 light = linearPremultiplied(colour, coverage);
  int curve = int(FRAME.flags >> kToneCurveShift);
  if (isFull && curve != kToneNone && coverage > 0.0) light = coverage * sceneFromDisplay(curve, light / coverage);
  light *= exposure;
  return isCoded ? displayPremultiplied(light, coverage) : light;
}

// What both formats of the colour image hold: from 0 to the largest half, 65504. NaN becomes 0.
vec3 storable(vec3 colour) { return mix(vec3(0.0), min(colour, vec3(65504.0)), greaterThan(colour, vec3(0.0))); }

// A vector of the asset's axes.
vec3 inWorld(vec3 vector) {
  return vec3(dot(FRAME.worldX.xyz, vector), dot(FRAME.worldY.xyz, vector), dot(FRAME.worldZ.xyz, vector));
}

// `pixel` counts from the region's corner; `colour` is display-coded, distance and normal in the world's units and
// axes.
void writePixel(uvec2 pixel, vec3 colour, float coverage, float exposure, float distance, vec3 normal,
                float deviceDepth) {
  ivec2 place = ivec2(pixel + uvec2(FRAME.regionX, FRAME.regionY));
  if ((FRAME.flags & kFlagColour) != 0) {
    imageStore(colourImage, place, vec4(storable(outputColour(colour, coverage, exposure)), coverage));
  }
  if ((FRAME.flags & kFlagDistance) != 0) imageStore(distanceImage, place, vec4(distance));
  if ((FRAME.flags & kFlagNormal) != 0) imageStore(normalImage, place, vec4(normal, 0.0));
  if ((FRAME.flags & kFlagDepth) != 0) imageStore(depthImage, place, vec4(deviceDepth));
}

#endif
