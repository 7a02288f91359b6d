#include "baker/bake/lattices.h"

#include <algorithm>
#include <cmath>

namespace froth {
namespace {

double largestExtent(const Foam& foam) {
  glm::dvec3 low(foam.sites[0]), high(foam.sites[0]);
  for (const glm::vec3& site : foam.sites) {
    low = glm::min(low, glm::dvec3(site));
    high = glm::max(high, glm::dvec3(site));
  }
  const glm::dvec3 size = high - low;
  const double extent = std::max({size.x, size.y, size.z});
  return extent > 0 ? extent : foam.radii[0];  // all sites in one place
}

}  // namespace

float stepOfBits(uint32_t bits) { return bits > 0 ? std::ldexp(1.0f, -static_cast<int>(bits)) : 0.0f; }

Quantization makeLattices(const Foam& foam, const BakeKnobs& knobs) {
  Quantization lattices;
  if (knobs.positionBits > 0) {
    lattices.positionStep = std::exp2(std::floor(std::log2(largestExtent(foam))) - knobs.positionBits);
  }
  lattices.radiusBits = knobs.radiusBits;
  lattices.densityBits = knobs.densityBits;
  lattices.normalBits = knobs.frameBits;
  lattices.detailSiteStep = stepOfBits(knobs.detailSiteBits);
  lattices.heightStep = stepOfBits(knobs.heightBits);
  if (knobs.compressColours) {
    lattices.colourStep = knobs.appearance.colourStep;
    lattices.lobeAxisStep = knobs.appearance.lobeAxisStep;
  }
  return lattices;
}

}  // namespace froth
