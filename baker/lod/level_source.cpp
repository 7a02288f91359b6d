#include "baker/lod/level_source.h"

#include "baker/lod/gather_cells.h"

namespace froth {

Foam gatherSnapped(const LevelSource& source, std::span<const uint32_t> cells, std::span<const uint8_t> isLive) {
  std::vector<uint32_t> sources;
  for (const uint32_t cell : cells) sources.push_back(source.cells.sources[cell]);
  Foam foam = gatherCells(source.input, source.merged, sources);
  for (size_t k = 0; k < cells.size(); ++k) {
    foam.sites[k] = source.cells.sites[cells[k]];
    foam.radii[k] = source.cells.radii[cells[k]];
    foam.densities[k] = isLive[k] ? source.cells.densities[cells[k]] : 0;
  }
  return foam;
}

}  // namespace froth
