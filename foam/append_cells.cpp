#include "foam/append_cells.h"

#include <algorithm>
#include <cstddef>

#include "foam/foam_arrays.h"

namespace froth {
namespace {

struct Range {
  uint64_t first, count;
};

// Where an array has the values of a cell.
Range rangeOf(const Foam& foam, FoamIndex index, uint32_t cell) {
  const uint64_t details = foam.detailCount, firstDetail = cell * details;
  if (index == FoamIndex::kCell) return {cell, 1};
  if (index == FoamIndex::kDetailSite) return {firstDetail, details};
  const LobeRange last = lobesOf(foam, firstDetail + details - 1);
  const uint64_t first = lobesOf(foam, firstDetail).first;
  return {first, last.first + last.count - first};
}

// Gives a foam whose detail sites all have the same number of lobes offsets to them.
void countLobes(Foam& foam) {
  const uint64_t details = uint64_t{foam.cellCount} * foam.detailCount;
  for (uint64_t detail = 0; detail <= details; ++detail) foam.lobeOffsets.push_back(detail * foam.lobeCount);
}

}  // namespace

void appendCells(const Foam& from, std::span<const uint32_t> cells, Foam& to) {
  const bool hasLobeOffsets =
      !from.lobeOffsets.empty() || !to.lobeOffsets.empty() || (to.cellCount > 0 && from.lobeCount != to.lobeCount);
  if (hasLobeOffsets && to.lobeOffsets.empty()) countLobes(to);
  const uint64_t details = from.detailCount;
  const bool hasBaseColours = !from.baseColours.empty() || !to.baseColours.empty();
  if (hasBaseColours) to.baseColours.resize(to.cellCount * details, glm::vec3(0));
  to.detailCount = from.detailCount;
  to.lobeCount = std::max(to.lobeCount, from.lobeCount);
  to.cellCount += static_cast<uint32_t>(cells.size());

  visitArrays([&](const FoamArray& array, auto values) {
    const auto& source = from.*values;
    if (source.empty()) return;
    for (const uint32_t cell : cells) {
      const Range range = rangeOf(from, array.index, cell);
      const auto begin = source.begin() + static_cast<std::ptrdiff_t>(range.first);
      (to.*values).insert((to.*values).end(), begin, begin + static_cast<std::ptrdiff_t>(range.count));
    }
  });
  if (hasBaseColours) to.baseColours.resize(uint64_t{to.cellCount} * details, glm::vec3(0));
  if (!hasLobeOffsets) return;
  for (const uint32_t cell : cells) {
    for (uint64_t k = 0; k < details; ++k) {
      to.lobeOffsets.push_back(to.lobeOffsets.back() + lobesOf(from, cell * details + k).count);
    }
  }
}

}  // namespace froth
