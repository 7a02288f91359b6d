// Levels of detail: a foam becomes coarser group by group (docs/STREAMING.md).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "baker/appearance/visibility.h"
#include "baker/cells/cells.h"
#include "baker/cells/chunk_plan.h"
#include "baker/lod/level_report.h"
#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"
#include "format/asset_contents.h"
#include "reference/camera/camera.h"

namespace froth {

struct LevelInput {
  const Foam& foam;
  const CellGraph& walk;   // the regular triangulation
  const CellGraph& alpha;  // part of it
  const ChunkPlan& plan;   // of level 0
  const Quantization& lattices;
  uint32_t chunkCells;                  // most live cells of a chunk
  const Visibility* visibility;         // of the foam; null: all cells show alike
  std::vector<View> views;              // what errors are measured in; empty: errors are distances between forms
  double nearRatio = 4, nearDepth = 0;  // where a view does not say
  bool fitsViews = false;               // merged cells descend towards what the views show of level 0
};

struct Levels {
  // Chunks of all levels, the floor first, level 0 last.
  ChunkPlan plan;
  std::vector<CellRows> rows;      // [chunks]
  std::vector<ChunkLevel> places;  // [chunks]
  uint32_t borderCount = 0;
  std::vector<LevelGroup> groups;  // none: nothing gets coarser, and all else is empty
  Foam merged;                     // BakeCells::sources continue into it
  // In which views merged cells show, by how much each does in its level: that is seen from where its cells look as
  // large as those of level 0 do to the cameras. None: nothing is known.
  std::optional<Visibility> sights;
  std::vector<LevelReport> reports;
};

// Merged cells go behind `cells`. The same input gives the same levels on any number of threads.
Result<Levels> makeLevels(const LevelInput& input, BakeCells& cells, const Progress& progress);

}  // namespace froth
