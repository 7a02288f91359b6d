// The cones around blocks of kBlockTiles x kBlockTiles tiles, from those of the tiles. A workgroup per block, a thread
// per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/pixel_cones.glsl"

const uint kThreads = kBlockTiles * kBlockTiles;
layout(local_size_x = kBlockTiles, local_size_y = kBlockTiles) in;

shared vec3 axes[kThreads];
shared float sines[kThreads];  // that a cone of the block needs to hold that of the tile

void main() {
  uint thread = gl_LocalInvocationIndex;
  uvec2 tile = gl_GlobalInvocationID.xy;
  bool isTile = tile.x < FRAME.tilesX && tile.y < FRAME.tilesY;
  vec4 cone = vec4(0.0, 0.0, 1.0, kConeOfNone);
  if (isTile) cone = FRAME.cones.v[tileConeAt(tileIndex(tile))];
  bool hasRays = cone.w >= 0.0;
  axes[thread] = hasRays ? cone.xyz : vec3(0.0);
  barrier();
  for (uint stride = kThreads / 2; stride > 0; stride /= 2) {
    if (thread < stride) axes[thread] += axes[thread + stride];
    barrier();
  }
  float size = length(axes[0]);
  vec3 axis = size > 0.0 ? axes[0] / size : vec3(0.0, 0.0, 1.0);
  sines[thread] = hasRays ? sineToHold(axis, cone) : -1.0;
  barrier();
  for (uint stride = kThreads / 2; stride > 0; stride /= 2) {
    if (thread < stride) sines[thread] = max(sines[thread], sines[thread + stride]);
    barrier();
  }
  if (thread != 0) return;
  uint block = gl_WorkGroupID.y * FRAME.blocksX + gl_WorkGroupID.x;
  FRAME.cones.v[blockConeAt(block)] = sines[0] < 0.0 ? vec4(axis, kConeOfNone) : guardedCone(axis, sines[0]);
}
