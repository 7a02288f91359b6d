#include "runtime/stream/level_graph.h"

#include <algorithm>

namespace froth {

LevelGraph::LevelGraph(const LevelTables& tables) : chunks_(tables.bytes.size()), groups_(tables.groups.size()) {
  for (uint32_t i = 0; i < chunkCount(); ++i) {
    const ChunkLevel level = tables.levels.empty() ? ChunkLevel{} : tables.levels[i];
    chunks_[i] = {level.madeBy, level.in, tables.bytes[i], tables.cells[i]};
    if (level.in == kNoGroup) {
      floor_.push_back(i);
      floorBytes_ += tables.bytes[i];
      floorCells_ += tables.cells[i];
    }
    if (level.madeBy == kNoGroup) {
      finestBytes_ += tables.bytes[i];
      finestCells_ += tables.cells[i];
    }
    allBytes_ += tables.bytes[i];
  }
  const std::vector<GroupBounds> bounds = boundGroups(tables.levels, tables.groups, tables.liveBoxes);
  for (uint32_t g = 0; g < groupCount(); ++g) {
    groups_[g].bounds = bounds[g];
    groups_[g].error = tables.groups[g].error;
  }
  fine_ = chunksBy(&Chunk::in);
  coarse_ = chunksBy(&Chunk::madeBy);
  coarser_ = groupsOf(coarse_, &Chunk::in);
  finer_ = groupsOf(fine_, &Chunk::madeBy);
  for (uint32_t g = 0; g < groupCount(); ++g) {
    if (coarserThan(g).empty()) lowest_.push_back(g);
  }
  setPrices();
}

LevelGraph::Rows LevelGraph::chunksBy(uint32_t Chunk::*field) const {
  Rows rows;
  rows.offsets.assign(groups_.size() + 1, 0);
  for (const Chunk& chunk : chunks_) {
    if (chunk.*field != kNoGroup) ++rows.offsets[chunk.*field + 1];
  }
  for (uint32_t g = 0; g < groupCount(); ++g) rows.offsets[g + 1] += rows.offsets[g];
  rows.items.resize(rows.offsets.back());
  std::vector<uint32_t> ends(rows.offsets.begin(), rows.offsets.end() - 1);
  for (uint32_t i = 0; i < chunkCount(); ++i) {
    if (chunks_[i].*field != kNoGroup) rows.items[ends[chunks_[i].*field]++] = i;
  }
  return rows;
}

LevelGraph::Rows LevelGraph::groupsOf(const Rows& chunks, uint32_t Chunk::*field) const {
  Rows rows;
  for (uint32_t g = 0; g < groupCount(); ++g) {
    const auto begin = static_cast<std::ptrdiff_t>(rows.items.size());
    for (const uint32_t chunk : chunks.row(g)) {
      if (chunks_[chunk].*field != kNoGroup) rows.items.push_back(chunks_[chunk].*field);
    }
    std::sort(rows.items.begin() + begin, rows.items.end());
    rows.items.erase(std::unique(rows.items.begin() + begin, rows.items.end()), rows.items.end());
    rows.offsets.push_back(static_cast<uint32_t>(rows.items.size()));
  }
  return rows;
}

void LevelGraph::setPrices() {
  for (uint32_t g = 0; g < groupCount(); ++g) {
    uint64_t fineBytes = 0, fineCells = 0, coarseBytes = 0, coarseCells = 0;
    for (const uint32_t chunk : fineOf(g)) {
      fineBytes += chunks_[chunk].bytes;
      fineCells += chunks_[chunk].cells;
    }
    for (const uint32_t chunk : coarseOf(g)) {
      if (chunks_[chunk].in != kNoGroup) coarseBytes += chunks_[chunk].bytes;
      coarseCells += chunks_[chunk].cells;
    }
    groups_[g].bytePrice = fineBytes - std::min(fineBytes, coarseBytes);
    groups_[g].cellPrice = fineCells - std::min(fineCells, coarseCells);
    mostCoarseBytes_ = std::max(mostCoarseBytes_, coarseBytes);
  }
}

}  // namespace froth
