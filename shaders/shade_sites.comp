// The colour of each detail site of the visible cells, seen from the eye. A thread per detail site.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/cell_bits.glsl"
#include "foam/appearance.h"

layout(local_size_x = kGroupSize) in;
layout(constant_id = kConstantDetailCount) const uint detailCount = 8;
layout(constant_id = kConstantLobeCount) const uint lobeCount = 8;

const float kLowest = -3.402823466e38;

vec3 siteColour(CellCode code, CellHeader header, uint detail, vec3 base, vec3 direction) {
  float weightSum = 0.0;
  vec3 colourSum = vec3(0.0);
  if (lobeCount > 0) {
    Lobes lobes = loadLobes(code, header, detailCount, detail);
    float largest = kLowest;
    for (uint lobe = 0; lobe < lobes.count; ++lobe) {
      float exponent = lobeExponent(takeAxis(code, header, lobes), direction);
      addLobe(exponent, takeLobeColour(code, header, lobes), largest, weightSum, colourSum);
    }
  }
  return lobeColour(base, weightSum, colourSum);
}

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
  vec3 direction = lensClass == kLensClassOrthographic ? FRAME.forward.xyz : normalize(toSite);
  vec3 colour = siteColour(code, header, detail, site.base, direction);

  vec3 shown = min(colour, vec3(65504.0));  // the largest half
  FRAME.sites.v[index] =
      SiteRecord(site.place, site.height, 0u, uvec2(packHalf2x16(shown.rg), packHalf2x16(vec2(shown.b, 0.0))));
}
