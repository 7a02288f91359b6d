#include "measure/stability/cases/foam_parts.h"

#include <algorithm>

namespace froth {
namespace {

// Details [0, details) of a cell, each with its first `lobes` lobes.
void appendDetails(const Foam& foam, uint32_t cell, uint32_t details, uint32_t lobes, Foam& kept) {
  for (uint32_t k = 0; k < details; ++k) {
    const size_t site = size_t{cell} * foam.detailCount + k;
    kept.detailSites.push_back(foam.detailSites[site]);
    kept.detailHeights.push_back(foam.detailHeights[site]);
    if (!foam.baseColours.empty()) kept.baseColours.push_back(foam.baseColours[site]);
    const LobeRange range = lobesOf(foam, site);
    for (uint64_t m = range.first; m < range.first + std::min(lobes, range.count); ++m) {
      kept.lobeAxes.push_back(foam.lobeAxes[m]);
      kept.lobeColours.push_back(foam.lobeColours[m]);
    }
    if (!foam.lobeOffsets.empty()) kept.lobeOffsets.push_back(kept.lobeAxes.size());
  }
}

Foam keep(const Foam& foam, std::span<const uint32_t> cells, uint32_t details, uint32_t lobes) {
  Foam kept;
  kept.cellCount = static_cast<uint32_t>(cells.size());
  kept.detailCount = details;
  kept.lobeCount = lobes;
  if (!foam.lobeOffsets.empty()) kept.lobeOffsets = {0};
  for (const uint32_t cell : cells) {
    kept.sites.push_back(foam.sites[cell]);
    kept.radii.push_back(foam.radii[cell]);
    kept.densities.push_back(foam.densities[cell]);
    kept.orientations.push_back(foam.orientations[cell]);
    appendDetails(foam, cell, details, lobes, kept);
  }
  return kept;
}

}  // namespace

Foam keepCells(const Foam& foam, std::span<const uint32_t> cells) {
  return keep(foam, cells, foam.detailCount, foam.lobeCount);
}

Foam keepDetails(const Foam& foam, uint32_t details, uint32_t lobes) {
  std::vector<uint32_t> all(foam.cellCount);
  for (uint32_t i = 0; i < foam.cellCount; ++i) all[i] = i;
  return keep(foam, all, details, lobes);
}

}  // namespace froth
