// A chunk of some level, while levels are made.
#pragma once

#include "baker/cells/chunk_plan.h"
#include "format/asset_contents.h"

namespace froth {

struct LevelChunk {
  PlannedChunk planned;
  CellRows rows;  // of its cells
  ChunkLevel place;
};

}  // namespace froth
