// Which instance and cell stands where a pixel's ray was stopped.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/hit_pass.glsl"

layout(set = 0, binding = 0, rg32ui) uniform writeonly uimage2D idImage;

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (!isInRegion(pixel)) return;
  Hit hit = loadHit(pixel);
  uvec2 id = uvec2(kNoCell);
  if (hit.cellCode != kNoCell) id = uvec2(HITS.instances.v[hit.instance].userId, hit.cellCode);
  imageStore(idImage, ivec2(pixel + uvec2(HITS.regionX, HITS.regionY)), uvec4(id, 0, 0));
}
