#include "baker/lod/split_form.h"

#include <algorithm>
#include <utility>

#include "baker/cells/mark_cells.h"

namespace froth {

Result<std::vector<LevelChunk>> splitForm(CoarseForm& form, std::span<const uint32_t> ring, uint32_t firstMerged,
                                          const BakeCells& cells, uint32_t chunkCells, double positionStep) {
  const auto ownCount = static_cast<uint32_t>(form.isEmpty.size()), keptCount = static_cast<uint32_t>(form.kept.size());
  const auto cellOf = [&](uint32_t local) {
    if (local >= ownCount) return ring[local - ownCount];
    return local < keptCount ? form.kept[local] : firstMerged + (local - keptCount);
  };
  CellRows rows = std::move(form.rows);
  for (CellGraph* graph : {&rows.walk, &rows.alpha}) {
    for (uint32_t& neighbour : graph->neighbours) neighbour = cellOf(neighbour);
    for (uint32_t local = 0; local < ownCount; ++local) {
      const auto begin = graph->neighbours.begin();
      std::sort(begin + graph->offsets[local], begin + graph->offsets[local + 1]);
    }
  }
  std::vector<uint32_t> live, others;
  std::vector<std::pair<uint32_t, uint32_t>> places;
  for (uint32_t local = 0; local < ownCount; ++local) {
    const uint32_t cell = cellOf(local);
    places.emplace_back(cell, local);
    (stateOf(cells, cell, false, form.isEmpty[local]) == CellState::kLive ? live : others).push_back(cell);
  }
  std::sort(places.begin(), places.end());
  const auto placeOf = [&](uint32_t cell) {
    return std::lower_bound(places.begin(), places.end(), std::pair(cell, 0u))->second;
  };
  const auto rowOf = [&](uint32_t cell) { return neighboursOf(rows.walk, placeOf(cell)); };
  Result<std::vector<PlannedChunk>> planned =
      splitIntoChunks(cells, std::move(live), std::move(others), rowOf, chunkCells, positionStep, {});
  if (!planned) return planned.error();
  std::vector<LevelChunk> chunks;
  for (PlannedChunk& chunk : *planned) {
    std::vector<uint32_t> locals;
    for (const uint32_t cell : chunk.cells) locals.push_back(placeOf(cell));
    CellRows own = gatherRows(rows.walk, rows.alpha, locals);
    chunks.push_back({std::move(chunk), std::move(own), {}});
  }
  return chunks;
}

}  // namespace froth
