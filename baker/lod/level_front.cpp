#include "baker/lod/level_front.h"

#include <numeric>

#include "baker/lod/front_image.h"
#include "foam/append_cells.h"

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

LevelFront gatherPlannedFront(const LevelSource& source, std::span<const LevelChunk> chunks,
                              std::span<const MergePlan* const> plans) {
  std::vector<uint8_t> isMerged(source.cells.count(), 0);
  for (const MergePlan* plan : plans) {
    for (const std::vector<uint32_t>& cluster : plan->clusters) {
      for (const uint32_t cell : cluster) isMerged[cell] = 1;
    }
  }
  LevelFront front = gatherFront(source, chunks, isMerged);
  front.owners.assign(front.foam.cellCount, kNoOwner);
  uint32_t merges = 0;
  for (const MergePlan* plan : plans) {
    std::vector<uint32_t> all(plan->clusters.size());
    std::iota(all.begin(), all.end(), 0u);
    appendCells(plan->merged, all, front.foam);
    for (size_t k = 0; k < all.size(); ++k) front.owners.push_back(merges++);
  }
  return front;
}

}  // namespace froth
