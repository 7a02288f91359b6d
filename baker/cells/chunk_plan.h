// Which cell lies where in the asset. Internal to the baker.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "baker/cells/cells.h"
#include "base/progress.h"
#include "base/result.h"
#include "foam/cell_graph.h"
#include "format/asset_contents.h"

namespace froth {

struct PlannedChunk {
  std::vector<uint32_t> cells;  // in the order of the asset, live ones first
  uint32_t liveCount = 0;
};

struct ChunkPlan {
  std::vector<PlannedChunk> chunks;  // >= 1
  uint32_t localBits = 32;
  // [cells] where each lies, of cells with a place only; with levels the border number of those that have one
  std::vector<CellRef> refs;
};

inline constexpr CellRef kNoRef = 0xffffffff;

// The rows of some cells, one after the other; neighbours are cells of the scene, ascending.
struct CellRows {
  CellGraph walk;   // the regular triangulation
  CellGraph alpha;  // part of it
};

// Of the listed cells, from the graphs of the scene.
CellRows gatherRows(const CellGraph& walk, const CellGraph& alpha, std::span<const uint32_t> cells);

// The neighbours of a cell in the regular triangulation, as cells of the scene.
using RowOf = std::function<std::span<const uint32_t>(uint32_t cell)>;

// kd-median chunks of at most `chunkCells` live cells, in each the live cells, then the others, both in the order of
// cell_order.h. Splits and order of the live cells know no others, so that a Steiner cell moves none of them. Each of
// the others is in the chunk that has most of its neighbours: one in the open touches hundreds of cells.
Result<std::vector<PlannedChunk>> splitIntoChunks(const BakeCells& cells, std::vector<uint32_t> live,
                                                  std::vector<uint32_t> others, const RowOf& rowOf, uint32_t chunkCells,
                                                  double positionStep, const Progress& progress);

// Bits for the local index of a CellRef, so that there are enough for the chunks too.
Result<uint32_t> chooseLocalBits(std::span<const PlannedChunk> chunks);

// The chunks of a scene without levels, of all cells with a place.
Result<ChunkPlan> planChunks(const BakeCells& cells, const std::vector<CellState>& states, const CellGraph& walk,
                             uint32_t chunkCells, double positionStep, const Progress& progress);

}  // namespace froth
