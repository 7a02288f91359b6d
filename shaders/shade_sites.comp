// The colour of each detail site of the visible cells, seen from the eye. A thread per detail site.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/asset.glsl"
#include "foam/appearance.h"

layout(local_size_x = kGroupSize) in;
layout(constant_id = kConstantDetailCount) const uint detailCount = 8;
layout(constant_id = kConstantLobeCount) const uint lobeCount = 8;
layout(constant_id = kConstantHasHeights) const bool hasHeights = true;

vec3 loadTriple(FloatArray values, uint index) { return vec3(values.v[index], values.v[index + 1], values.v[index + 2]); }

vec3 siteColour(uint chunk, uint firstLobe, vec3 direction) {
  FloatArray axes = FRAME.chunks.v[chunk].lobeAxes;
  FloatArray colours = FRAME.chunks.v[chunk].lobeColours;
  float largest = lobeExponent(loadTriple(axes, 3 * firstLobe), direction);
  float weightSum = 0.0;
  vec3 colourSum = vec3(0.0);
  for (uint lobe = firstLobe; lobe < firstLobe + lobeCount; ++lobe) {
    float exponent = lobeExponent(loadTriple(axes, 3 * lobe), direction);
    addLobe(exponent, loadTriple(colours, 3 * lobe), largest, weightSum, colourSum);
  }
  return lobeColour(vec3(0.0), weightSum, colourSum);
}

void main() {
  uint index = linearGroup() * kGroupSize + gl_LocalInvocationIndex;
  uint visible = index / detailCount;
  uint detail = index % detailCount;
  if (visible >= COUNTERS.visibleCells) return;
  if ((FRAME.flags & kFlagOnlyPaired) != 0 && FRAME.tileCounts.v[visible] == 0) return;

  uvec4 cell = FRAME.visibleCells.v[checked(FRAME.order.v[visible], FRAME.visibleCapacity)];
  uint site = checked(cell.y, FRAME.chunks.v[cell.x].liveCount) * detailCount + detail;
  vec2 place = FRAME.chunks.v[cell.x].detailSites.v[site];
  float height = hasHeights ? FRAME.chunks.v[cell.x].detailHeights.v[site] : 0.0;

  CellRecord record = FRAME.records.v[visible];
  vec3 offset = record.tangent.xyz * place.x + record.bitangent.xyz * place.y;
  vec3 toSite = record.ball.xyz + record.ball.w * offset;
  vec3 colour = siteColour(cell.x, site * lobeCount, normalize(toSite));

  uint place3 = 3 * index;
  FRAME.sites.v[place3] = place;
  FRAME.sites.v[place3 + 1] = vec2(height, colour.r);
  FRAME.sites.v[place3 + 2] = colour.gb;
}
