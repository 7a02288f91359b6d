// Where the cells of groups of levels are (docs/STREAMING.md "Which chunks are wanted"): the baker measures errors, and
// the runtime chooses groups, by the same distance.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "format/asset_contents.h"

namespace froth {

// A box around the balls of a group's live cells, of both forms, and around the bounds of the groups that lie finer
// below.
struct GroupBounds {
  glm::dvec3 low{0}, high{0};  // [scene units]
};

// No live cell of the group, or of those below it, is nearer to the point; 0 inside. That of a coarser group is no
// greater, however it is rounded: each step is monotone.
inline double distanceTo(const GroupBounds& bounds, const glm::dvec3& point) {
  return glm::length(glm::max(glm::max(bounds.low - point, point - bounds.high), 0.0));
}

// A chunk's live_bounds, which are relative to its origin, in the axes of the scene. All zero stays: no live cells.
Box placeBox(const std::array<double, 3>& origin, const Box& box);

// [groups]; liveBoxes: [chunks] in the axes of the scene. Levels and groups as FORMAT.md asks for.
std::vector<GroupBounds> boundGroups(std::span<const ChunkLevel> levels, std::span<const LevelGroup> groups,
                                     std::span<const Box> liveBoxes);

// Of contents with all of their chunks.
std::vector<GroupBounds> boundGroups(const AssetContents& contents);

}  // namespace froth
