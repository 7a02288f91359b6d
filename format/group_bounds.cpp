#include "format/group_bounds.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "format/checks.h"
#include "format/to_vector.h"

namespace froth {
namespace {

bool hasNothing(const Box& box) { return box.min == std::array<double, 3>{} && box.max == box.min; }

void include(GroupBounds& bounds, const glm::dvec3& low, const glm::dvec3& high) {
  bounds.low = glm::min(bounds.low, low);
  bounds.high = glm::max(bounds.high, high);
}

}  // namespace

Box placeBox(const std::array<double, 3>& origin, const Box& box) {
  if (hasNothing(box)) return box;
  Box placed;
  for (size_t axis = 0; axis < 3; ++axis) {
    placed.min[axis] = origin[axis] + box.min[axis];
    placed.max[axis] = origin[axis] + box.max[axis];
  }
  return placed;
}

std::vector<GroupBounds> boundGroups(std::span<const ChunkLevel> levels, std::span<const LevelGroup> groups,
                                     std::span<const Box> liveBoxes) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<GroupBounds> bounds(groups.size(), {glm::dvec3(kInfinity), glm::dvec3(-kInfinity)});
  for (size_t chunk = 0; chunk < levels.size(); ++chunk) {
    if (hasNothing(liveBoxes[chunk])) continue;
    for (const uint32_t group : {levels[chunk].in, levels[chunk].madeBy}) {
      if (group != kNoGroup) include(bounds[group], toVector(liveBoxes[chunk].min), toVector(liveBoxes[chunk].max));
    }
  }
  for (size_t group = 0; group < groups.size(); ++group) {
    const bool isEmpty = bounds[group].low.x > bounds[group].high.x;  // no live cells
    if (isEmpty) bounds[group].low = bounds[group].high = toVector(groups[group].centre);
  }
  std::vector<uint32_t> order(levels.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](uint32_t chunk) { return levels[chunk].level; });
  for (const uint32_t chunk : order) {  // finer ones first: what made the chunk is whole
    const ChunkLevel& place = levels[chunk];
    if (place.in == kNoGroup || place.madeBy == kNoGroup) continue;
    include(bounds[place.in], bounds[place.madeBy].low, bounds[place.madeBy].high);
  }
  return bounds;
}

std::vector<GroupBounds> boundGroups(const AssetContents& contents) {
  std::vector<Box> boxes;
  for (const ChunkContents& chunk : contents.chunks) boxes.push_back(placeBox(chunk.origin, liveBoundsOf(chunk)));
  return boundGroups(contents.levels, contents.groups, boxes);
}

}  // namespace froth
