#include "baker/lod/gather_cells.h"

#include <vector>

#include "foam/append_cells.h"

namespace froth {

Foam gatherCells(const Foam& input, const Foam& merged, std::span<const uint32_t> sources) {
  Foam gathered;
  appendCells(input, {}, gathered);
  std::vector<uint32_t> run;  // cells in a row of the same foam
  for (size_t k = 0; k < sources.size(); ++k) {
    const bool isMerged = sources[k] >= input.cellCount;
    run.push_back(isMerged ? sources[k] - input.cellCount : sources[k]);
    const bool isLast = k + 1 == sources.size() || (sources[k + 1] >= input.cellCount) != isMerged;
    if (!isLast) continue;
    appendCells(isMerged ? merged : input, run, gathered);
    run.clear();
  }
  return gathered;
}

}  // namespace froth
