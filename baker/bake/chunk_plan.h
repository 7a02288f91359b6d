// Which cell lies where in the asset. Internal to baker/bake.
#pragma once

#include <cstdint>
#include <vector>

#include "baker/bake/cells.h"
#include "base/progress.h"
#include "base/result.h"
#include "format/asset_contents.h"

namespace froth {

struct PlannedChunk {
  std::vector<uint32_t> cells;  // in the order of the asset, live ones first
  uint32_t liveCount = 0;
};

struct ChunkPlan {
  std::vector<PlannedChunk> chunks;  // >= 1
  uint32_t localBits = 32;
  std::vector<CellRef> refs;  // [cells] where each lies; of cells with a place only

  uint32_t chunkOf(CellRef ref) const { return localBits < 32 ? ref >> localBits : 0; }
  uint32_t localOf(CellRef ref) const { return localBits < 32 ? ref & ((1u << localBits) - 1) : ref; }
};

// kd-median chunks of at most `chunkCells` live cells, in each the live cells, then the others, both in the order of
// cell_order.h. Splits and order of the live cells know no others, so that a Steiner cell moves none of them.
Result<ChunkPlan> planChunks(const BakeCells& cells, const std::vector<CellState>& states, uint32_t chunkCells,
                             double positionStep, const Progress& progress);

}  // namespace froth
