#include "baker/lod/level_front.h"

namespace froth {

LevelFront gatherFront(const LevelSource& source, std::span<const LevelChunk> chunks,
                       std::span<const uint8_t> isLeftOut) {
  LevelFront front;
  std::vector<uint8_t> isLive;
  for (uint32_t index = 0; index < chunks.size(); ++index) {
    const LevelChunk& chunk = chunks[index];
    if (chunk.place.in != kNoGroup) continue;
    for (uint32_t local = 0; local < chunk.planned.cells.size(); ++local) {
      const uint32_t cell = chunk.planned.cells[local];
      if (source.cells.sources[cell] == kNoSource || (!isLeftOut.empty() && isLeftOut[cell])) continue;
      front.cells.push_back(cell);
      front.owners.push_back(index);
      isLive.push_back(local < chunk.planned.liveCount ? 1 : 0);
    }
  }
  front.foam = gatherSnapped(source, front.cells, isLive);
  return front;
}

}  // namespace froth
