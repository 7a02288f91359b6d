// What the passes over hits share. A workgroup per kSubTileSize x kSubTileSize pixels.
#ifndef FROTH_GPU_HIT_PASS_GLSL
#define FROTH_GPU_HIT_PASS_GLSL
#extension GL_EXT_buffer_reference : require
#include "gpu/layout.h"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

layout(push_constant) uniform Push {
  HitRef block;
} push;

#define HITS push.block.v

struct Hit {
  float distance;  // +inf: none
  uint instance;
  uint cellCode;   // kNoCell: none
};

bool isInRegion(uvec2 pixel) { return pixel.x < HITS.regionWidth && pixel.y < HITS.regionHeight; }

Hit loadHit(uvec2 pixel) {
  uint place = kHitWords * (pixel.y * HITS.regionWidth + pixel.x);
  return Hit(uintBitsToFloat(HITS.hits.v[place]), HITS.hits.v[place + 1], HITS.hits.v[place + 2]);
}

#endif
