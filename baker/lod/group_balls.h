// Balls around groups of levels, and boxes around their chunks.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "baker/cells/cells.h"
#include "baker/lod/level_chunk.h"
#include "format/asset_contents.h"

namespace froth {

struct GroupBall {
  glm::dvec3 centre{0};
  double radius = 0;
};

// Appends the balls of a chunk's live cells.
void addLiveBalls(const BakeCells& cells, const PlannedChunk& chunk, std::vector<GroupBall>& balls);

// Around the live cells of a chunk; all zero without any.
Box boxAroundLive(const BakeCells& cells, const PlannedChunk& chunk);

// A ball that holds all of them, whatever double rounds; not the smallest one.
GroupBall boundBalls(std::span<const GroupBall> balls);

}  // namespace froth
