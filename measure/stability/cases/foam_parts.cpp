#include "measure/stability/cases/foam_parts.h"

#include <numeric>
#include <vector>

#include "foam/pick_foam.h"

namespace froth {
namespace {

Foam keep(const Foam& foam, std::span<const uint32_t> cells, uint32_t details, uint32_t lobes) {
  std::vector<uint64_t> kept;
  for (const uint32_t cell : cells) {
    for (uint32_t k = 0; k < details; ++k) kept.push_back(uint64_t{cell} * foam.detailCount + k);
  }
  return pickFoam(foam, {.cells = cells, .details = kept, .detailCount = details, .mostLobes = lobes});
}

}  // namespace

Foam keepCells(const Foam& foam, std::span<const uint32_t> cells) {
  return keep(foam, cells, foam.detailCount, foam.lobeCount);
}

Foam keepDetails(const Foam& foam, uint32_t details, uint32_t lobes) {
  std::vector<uint32_t> all(foam.cellCount);
  std::iota(all.begin(), all.end(), 0u);
  return keep(foam, all, details, lobes);
}

}  // namespace froth
