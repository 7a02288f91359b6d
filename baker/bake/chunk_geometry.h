// Fills the geometry of a chunk: sites and radii of own cells and ghosts, and the graph. Internal to baker/bake.
#pragma once

#include "baker/bake/cells.h"
#include "baker/bake/chunk_plan.h"
#include "foam/cell_graph.h"
#include "format/asset_contents.h"

namespace froth {

// What all chunks are made from.
struct SceneGraphs {
  const CellGraph& walk;   // the regular triangulation
  const CellGraph& alpha;  // part of it
  bool hasWalkGraph;
};

// Fills cellCount .. alphaCounts. positionStep 0: world coordinates.
ChunkContents makeChunkGeometry(const BakeCells& cells, const ChunkPlan& plan, uint32_t index,
                                const SceneGraphs& graphs, double positionStep);

}  // namespace froth
