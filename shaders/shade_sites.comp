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
  uint visible = index / detailCount;
  uint detail = index % detailCount;
  if (visible >= COUNTERS.visibleCells) return;
  if ((FRAME.flags & kFlagOnlyPaired) != 0 && FRAME.tileCounts.v[visible] == 0) return;

  uvec4 cell = FRAME.visibleCells.v[checked(FRAME.order.v[visible], FRAME.visibleCapacity)];
  CellCode code = FRAME.chunks.v[cell.x].code;
  CellHeader header = loadCellHeader(code, cell.x, cell.y);
  DetailSite site = loadDetailSite(code, header, detailCount, detail);

  CellRecord record = FRAME.records.v[visible];
  vec3 offset = record.tangent.xyz * site.place.x + record.bitangent.xyz * site.place.y;
  vec3 toSite = record.ball.xyz + record.ball.w * offset;
  vec3 colour = siteColour(code, header, detail, site.base, normalize(toSite));

  uint place3 = 3 * index;
  FRAME.sites.v[place3] = site.place;
  FRAME.sites.v[place3 + 1] = vec2(site.height, colour.r);
  FRAME.sites.v[place3 + 2] = colour.gb;
}
