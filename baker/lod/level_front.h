// All cells as the newest level has them. Internal to baker/lod.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/lod/level_chunk.h"
#include "baker/lod/level_source.h"
#include "baker/lod/merge_plan.h"
#include "foam/foam.h"

namespace froth {

struct LevelFront {
  Foam foam;  // on the lattices; without density where not live
  // [cells of the foam] Of the scene; the chunk that each is in.
  std::vector<uint32_t> cells, owners;
};

// Cells of the chunks that are in no group, without Steiner cells and those that `isLeftOut` [cells of the scene, or
// empty] marks.
LevelFront gatherFront(const LevelSource& source, std::span<const LevelChunk> chunks,
                       std::span<const uint8_t> isLeftOut = {});

// The level that the plans make of them. Owners are merges, numbered through the plans, or kNoOwner.
LevelFront gatherPlannedFront(const LevelSource& source, std::span<const LevelChunk> chunks,
                              std::span<const MergePlan* const> plans);

}  // namespace froth
