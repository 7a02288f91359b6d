// The colour of each detail site of the visible cells, seen from the eye. A thread per detail site.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/site_colour.glsl"

layout(local_size_x = kGroupSize) in;
layout(constant_id = kConstantDetailCount) const uint detailCount = 8;
layout(constant_id = kConstantLobeCount) const uint lobeCount = 8;

void main() {
  uint index = linearGroup() * kGroupSize + gl_LocalInvocationIndex;
  uint slot = index / detailCount;
  uint detail = index % detailCount;
  if (slot >= COUNTERS.visibleCells) return;

  uvec4 cell = FRAME.visibleCells.v[slot];
  Chunk chunk = loadChunk(cell.x);
  if (cell.y >= chunk.liveCount) return;
  CellCode code = FRAME.chunks.v[cell.x].code;
  CellHeader header = loadCellHeader(code, cell.x, cell.y);
  DetailSite site = loadDetailSite(code, header, detailCount, detail);

  BitCursor bits = cellBits(cell.x, cell.y);
  takeDensity(code, bits);
  Frame frame = takeFrame(code, bits);
  Ball ball = ballOfSite(chunk, cell.y);
  vec3 toSite = ball.centre + ball.radius * (frame.tangent * site.place.x + frame.bitangent * site.place.y);
  vec3 direction = lensClass == kLensClassOrthographic ? FRAME.forward.xyz : directionToSite(toSite, frame.normal);
  vec3 colour = siteColour(code, header, detailCount, lobeCount > 0, detail, site.base, direction);

  if (floatColours) {
    FRAME.sites.v[index] = SiteRecord(site.place, site.height, floatBitsToUint(colour.b), floatBitsToUint(colour.rg));
    return;
  }
  FRAME.sites.v[index] =
      SiteRecord(site.place, site.height, 0u, uvec2(packHalf2x16(colour.rg), packHalf2x16(vec2(colour.b, 0.0))));
}
