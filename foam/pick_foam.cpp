#include "foam/pick_foam.h"

#include <algorithm>
#include <cstddef>

#include "foam/foam_arrays.h"

namespace froth {

Foam pickFoam(const Foam& foam, const FoamPick& pick) {
  Foam part;
  part.cellCount = static_cast<uint32_t>(pick.cells.size());
  part.detailCount = pick.detailCount;
  part.lobeCount = pick.mostLobes;
  const auto keptLobes = [&](uint64_t detail) {
    const LobeRange lobes = lobesOf(foam, detail);
    return LobeRange{lobes.first, std::min(lobes.count, pick.mostLobes)};
  };
  visitArrays([&](const FoamArray& array, auto values) {
    const auto& from = foam.*values;
    if (from.empty()) return;
    const auto take = [&](uint64_t first, uint64_t count) {
      const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
      (part.*values).insert((part.*values).end(), begin, begin + static_cast<std::ptrdiff_t>(count));
    };
    if (array.index == FoamIndex::kCell) {
      for (const uint32_t cell : pick.cells) take(cell, 1);
      return;
    }
    for (const uint64_t detail : pick.details) {
      const LobeRange range = array.index == FoamIndex::kLobe ? keptLobes(detail) : LobeRange{detail, 1};
      take(range.first, range.count);
    }
  });
  if (foam.lobeOffsets.empty()) return part;
  part.lobeOffsets = {0};
  for (const uint64_t detail : pick.details) {
    part.lobeOffsets.push_back(part.lobeOffsets.back() + keptLobes(detail).count);
  }
  return part;
}

}  // namespace froth
