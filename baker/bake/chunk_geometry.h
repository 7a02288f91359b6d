// Fills the geometry of a chunk: sites and radii of own cells and ghosts, and the graph. Internal to baker/bake.
#pragma once

#include <span>

#include "baker/cells/cells.h"
#include "baker/cells/chunk_plan.h"
#include "format/asset_contents.h"

namespace froth {

// Fills cellCount .. alphaCounts. `rows`: of the chunk's cells. `refs`: ChunkPlan::refs. Without a walk graph rows have
// the alpha-complex of live cells alone. With levels it fills the borders too. positionStep 0: world coordinates.
struct ChunkGeometryOptions {
  bool hasWalkGraph = true;
  bool hasLevels = false;
  double positionStep = 0;
};
ChunkContents makeChunkGeometry(const BakeCells& cells, const PlannedChunk& planned, const CellRows& rows,
                                std::span<const CellRef> refs, const ChunkGeometryOptions& options);

}  // namespace froth
