// Where the cells of groups of levels are (docs/STREAMING.md "Which chunks are wanted"): the baker measures errors, and
// the runtime chooses groups, by the same distance.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "format/asset_contents.h"

namespace froth {

// Each holds the balls of a group's live cells, of both forms, and the same bound of the groups that lie finer below.
struct GroupBounds {
  glm::dvec3 centre{0};  // a ball: LevelGroup's [scene units]
  double radius = 0;
  glm::dvec3 low{0}, high{0};  // a box [scene units]
};

// No live cell of the group, or of those below it, is nearer to the point; 0 where both bounds hold it. That of a
// coarser group is no greater, for both of its bounds hold those of this one.
inline double distanceTo(const GroupBounds& bounds, const glm::dvec3& point) {
  const glm::dvec3 outside = glm::max(glm::max(bounds.low - point, point - bounds.high), 0.0);
  return std::max(glm::length(outside), glm::length(point - bounds.centre) - bounds.radius);
}

// A chunk's live_bounds, which are relative to its origin, in the axes of the scene. All zero stays: no live cells.
Box placeBox(const std::array<double, 3>& origin, const Box& box);

// [groups]; liveBoxes: [chunks] in the axes of the scene. Levels and groups as FORMAT.md asks for.
std::vector<GroupBounds> boundGroups(std::span<const ChunkLevel> levels, std::span<const LevelGroup> groups,
                                     std::span<const Box> liveBoxes);

// Of contents with all of their chunks.
std::vector<GroupBounds> boundGroups(const AssetContents& contents);

}  // namespace froth
