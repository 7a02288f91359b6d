// Balls around the solid parts of cells, tighter than the cells' own (shaders/foam/solid_ball.h says what is solid).
// Internal to baker/bake.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "format/asset_contents.h"

namespace froth {

// ChunkContents::solidBalls of a chunk that is otherwise complete up to its detail heights. Each decodes to a ball that
// holds the cell's solid part with the margin; a cell that would gain less than 1/32 of its radius keeps its own ball.
// On all cores, the same result on any number of them.
std::vector<uint32_t> makeSolidBalls(const ChunkContents& chunk, uint32_t detailCount);

// The first live cell whose stored ball does not hold its solid part with the margin. A cell's own ball does.
std::optional<uint32_t> findWrongSolidBall(const ChunkContents& chunk, uint32_t detailCount);

}  // namespace froth
