// The colour of each detail site of the visible cells, seen from the eye. A thread per detail site.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/asset.glsl"
#include "foam/appearance.h"

layout(local_size_x = kGroupSize) in;
layout(constant_id = kConstantDetailCount) const uint detailCount = 8;
layout(constant_id = kConstantLobeCount) const uint lobeCount = 8;
layout(constant_id = kConstantHasHeights) const bool hasHeights = true;
layout(constant_id = kConstantHasBaseColours) const bool hasBaseColours = true;
layout(constant_id = kConstantHasLobeOffsets) const bool hasLobeOffsets = true;

const float kLowest = -3.402823466e38;

vec3 loadTriple(FloatArray values, uint index) {
  return vec3(values.v[3 * index], values.v[3 * index + 1], values.v[3 * index + 2]);
}

// A chunk whose values are all zero has no array, though others have one.
bool hasPart(uint chunk, uint part) { return (FRAME.chunks.v[chunk].parts & part) != 0; }

// Begin and end of a detail site's lobes.
uvec2 lobesOf(uint chunk, uint site) {
  if (hasLobeOffsets && hasPart(chunk, kPartLobeOffsets)) {
    return uvec2(FRAME.chunks.v[chunk].lobeOffsets.v[site], FRAME.chunks.v[chunk].lobeOffsets.v[site + 1]);
  }
  return uvec2(site * lobeCount, (site + 1) * lobeCount);
}

vec3 siteColour(uint chunk, uint site, vec3 direction) {
  vec3 base = vec3(0.0);
  if (hasBaseColours && hasPart(chunk, kPartBaseColours)) {
    FloatArray bases = FRAME.chunks.v[chunk].baseColours;
    base = loadTriple(bases, site);
  }
  float weightSum = 0.0;
  vec3 colourSum = vec3(0.0);
  if (lobeCount > 0) {
    FloatArray axes = FRAME.chunks.v[chunk].lobeAxes;
    FloatArray colours = FRAME.chunks.v[chunk].lobeColours;
    uvec2 lobes = lobesOf(chunk, site);
    float largest = kLowest;
    for (uint lobe = lobes.x; lobe < lobes.y; ++lobe) {
      float exponent = lobeExponent(loadTriple(axes, lobe), direction);
      addLobe(exponent, loadTriple(colours, lobe), largest, weightSum, colourSum);
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
  uint site = checked(cell.y, FRAME.chunks.v[cell.x].liveCount) * detailCount + detail;
  vec2 place = FRAME.chunks.v[cell.x].detailSites.v[site];
  float height = 0.0;
  if (hasHeights && hasPart(cell.x, kPartHeights)) height = FRAME.chunks.v[cell.x].detailHeights.v[site];

  CellRecord record = FRAME.records.v[visible];
  vec3 offset = record.tangent.xyz * place.x + record.bitangent.xyz * place.y;
  vec3 toSite = record.ball.xyz + record.ball.w * offset;
  vec3 colour = siteColour(cell.x, site, normalize(toSite));

  uint place3 = 3 * index;
  FRAME.sites.v[place3] = place;
  FRAME.sites.v[place3 + 1] = vec2(height, colour.r);
  FRAME.sites.v[place3 + 2] = colour.gb;
}
