#include "baker/lod/level_front.h"

#include "baker/lod/gather_cells.h"

namespace froth {

LevelFront gatherFront(const LevelSource& source, std::span<const LevelChunk> chunks,
                       std::span<const uint8_t> isLeftOut) {
  LevelFront front;
  std::vector<uint32_t> sources;
  std::vector<float> densities;
  for (uint32_t index = 0; index < chunks.size(); ++index) {
    const LevelChunk& chunk = chunks[index];
    if (chunk.place.in != kNoGroup) continue;
    for (uint32_t local = 0; local < chunk.planned.cells.size(); ++local) {
      const uint32_t cell = chunk.planned.cells[local];
      if (source.cells.sources[cell] == kNoSource || (!isLeftOut.empty() && isLeftOut[cell])) continue;
      front.cells.push_back(cell);
      front.owners.push_back(index);
      sources.push_back(source.cells.sources[cell]);
      densities.push_back(local < chunk.planned.liveCount ? source.cells.densities[cell] : 0);
    }
  }
  front.foam = gatherCells(source.input, source.merged, sources);
  for (size_t k = 0; k < front.cells.size(); ++k) {
    front.foam.sites[k] = source.cells.sites[front.cells[k]];
    front.foam.radii[k] = source.cells.radii[front.cells[k]];
  }
  front.foam.densities = std::move(densities);
  return front;
}

}  // namespace froth
