// The look of a view without anything in it: colour 0, distance +inf, normal 0, no cell.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/hits.glsl"
#include "gpu/outputs.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (!isInRegion(pixel)) return;
  writePixel(pixel, vec3(0.0), 0.0, 1.0, kInfinity, vec3(0.0), FRAME.depthRange.w);
  if (wantsHits()) writeHit(pixel, kInfinity, 0, kNoCell);
  if (wantsQuarters()) writeQuarters(pixel, vec4(kInfinity), uvec4(0));
}
