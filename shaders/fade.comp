// Between two cuts: keeps the colours of the one before, or mixes those that are kept with the colours of the one now.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#include "gpu/layout.h"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

layout(push_constant) uniform Push {
  FrameRef frame;
  UintPairArray kept;
  float weight;
} push;

layout(set = 0, binding = kBindingColour, FROTH_COLOUR_FORMAT) uniform image2D colourImage;

#define FRAME push.frame.v

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (pixel.x >= FRAME.regionWidth || pixel.y >= FRAME.regionHeight) return;
  ivec2 place = ivec2(pixel + uvec2(FRAME.regionX, FRAME.regionY));
  uint index = pixel.y * FRAME.regionWidth + pixel.x;
  vec4 now = imageLoad(colourImage, place);
  if (push.weight == 0.0) {
    push.kept.v[index] = uvec2(packHalf2x16(now.rg), packHalf2x16(now.ba));
    return;
  }
  uvec2 kept = push.kept.v[index];
  imageStore(colourImage, place, mix(vec4(unpackHalf2x16(kept.x), unpackHalf2x16(kept.y)), now, push.weight));
}
