// The chunks of a coarse form. Internal to baker/lod.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/lod/coarse_form.h"
#include "baker/lod/level_chunk.h"
#include "base/result.h"

namespace froth {

// Splits the form's cells into chunks of at most `chunkCells` live ones, whose rows name cells of the scene: the merged
// cells are those from `firstMerged` on, `ring` is that of the fine form. Takes the form's rows.
Result<std::vector<LevelChunk>> splitForm(CoarseForm& form, std::span<const uint32_t> ring, uint32_t firstMerged,
                                          const BakeCells& cells, uint32_t chunkCells, double positionStep);

}  // namespace froth
