#include "format/level_checks.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "format/limits.h"

namespace froth {
namespace {

constexpr char kRemedy[] = "bake the scene again";

using ull = unsigned long long;

std::string groupPlace(const std::string& file, uint32_t group) { return file + ": group " + std::to_string(group); }

std::string textOf(uint32_t group) { return group == kNoGroup ? "no group" : "group " + std::to_string(group); }

bool isFinite(double value, double least, double most) { return value >= least && value <= most; }  // false for NaN

Status checkGroup(const LevelGroup& group, const std::string& place) {
  for (const double value : group.centre) {
    if (!isFinite(value, -kMaxNumber, kMaxNumber)) {
      return makeError(ErrorKind::kBadInput, "%s: centre holds %g, not within +-2^50; %s", place.c_str(), value,
                       kRemedy);
    }
  }
  const std::pair<const char*, double> numbers[] = {{"radius", group.radius}, {"error", group.error}};
  for (const auto& [field, value] : numbers) {
    if (!isFinite(value, 0, 4.0 * kMaxNumber)) {
      return makeError(ErrorKind::kBadInput, "%s: %s is %g, not in 0..2^52; %s", place.c_str(), field, value, kRemedy);
    }
  }
  return {};
}

// That its groups exist, and are of its level and of the level below.
Status checkPlaceInGroups(const AssetContents& asset, const ChunkLevel& chunk, const std::string& place) {
  const size_t count = asset.groups.size();
  const std::pair<const char*, uint32_t> fields[] = {{"made_by", chunk.madeBy}, {"in", chunk.in}};
  for (const auto& [field, group] : fields) {
    if (group != kNoGroup && group >= count) {
      return makeError(ErrorKind::kBadInput, "%s: %s is group %u, there are %zu; %s", place.c_str(), field, group,
                       count, kRemedy);
    }
  }
  if ((chunk.level == 0) != (chunk.madeBy == kNoGroup)) {
    return makeError(ErrorKind::kBadInput,
                     "%s: level %u, made by %s: chunks of level 0 and no others are made by none; %s", place.c_str(),
                     chunk.level, textOf(chunk.madeBy).c_str(), kRemedy);
  }
  if (chunk.madeBy != kNoGroup && asset.groups[chunk.madeBy].level != chunk.level - 1) {
    return makeError(ErrorKind::kBadInput, "%s: level %u, made by group %u of level %u, not of the one below; %s",
                     place.c_str(), chunk.level, chunk.madeBy, asset.groups[chunk.madeBy].level, kRemedy);
  }
  if (chunk.in != kNoGroup && asset.groups[chunk.in].level != chunk.level) {
    return makeError(ErrorKind::kBadInput, "%s: level %u, in group %u of level %u; %s", place.c_str(), chunk.level,
                     chunk.in, asset.groups[chunk.in].level, kRemedy);
  }
  return {};
}

// Between the group that made a chunk and the one that it is in.
Status checkStep(const AssetContents& asset, const ChunkLevel& chunk, const std::string& file) {
  if (chunk.madeBy == kNoGroup || chunk.in == kNoGroup) return {};
  const LevelGroup &below = asset.groups[chunk.madeBy], &above = asset.groups[chunk.in];
  if (!(below.error < above.error)) {
    return makeError(ErrorKind::kBadInput,
                     "%s: error %.17g is not less than the %.17g of group %u, which is coarser; %s",
                     groupPlace(file, chunk.madeBy).c_str(), below.error, above.error, chunk.in, kRemedy);
  }
  if (!isBallWithin(below.centre, below.radius, above)) {
    return makeError(ErrorKind::kBadInput,
                     "%s: its ball of radius %g sticks out of that of group %u, which is coarser; %s",
                     groupPlace(file, chunk.madeBy).c_str(), below.radius, chunk.in, kRemedy);
  }
  return {};
}

// The floor first; in it, and behind it, coarser chunks before finer ones.
Status checkOrder(const AssetContents& asset, uint32_t index, const std::string& file) {
  if (index == 0) return {};
  const ChunkLevel &before = asset.levels[index - 1], &chunk = asset.levels[index];
  const bool isFloor = chunk.in == kNoGroup, wasFloor = before.in == kNoGroup;
  if (isFloor && !wasFloor) {
    return makeError(ErrorKind::kBadInput, "%s: belongs to the floor, but stands behind chunks that do not; %s",
                     chunkPlace(file, index).c_str(), kRemedy);
  }
  if (isFloor == wasFloor && chunk.level > before.level) {
    return makeError(ErrorKind::kBadInput, "%s: level %u behind level %u, levels must not rise; %s",
                     chunkPlace(file, index).c_str(), chunk.level, before.level, kRemedy);
  }
  return {};
}

Status checkForms(const AssetContents& asset, const std::string& file) {
  std::vector<uint32_t> fine(asset.groups.size()), coarse(asset.groups.size());
  for (const ChunkLevel& chunk : asset.levels) {
    if (chunk.in != kNoGroup) ++fine[chunk.in];
    if (chunk.madeBy != kNoGroup) ++coarse[chunk.madeBy];
  }
  for (uint32_t group = 0; group < fine.size(); ++group) {
    if (fine[group] > 0 && coarse[group] > 0) continue;
    return makeError(ErrorKind::kBadInput, "%s: %u fine and %u coarse chunks, it needs both; %s",
                     groupPlace(file, group).c_str(), fine[group], coarse[group], kRemedy);
  }
  return {};
}

Status checkBorderCounts(const AssetContents& asset, std::span<const ChunkIndex> chunks, const std::string& file) {
  uint64_t most = 0;
  for (uint32_t index = 0; index < chunks.size(); ++index) {
    const ChunkCounts& counts = chunks[index].counts;
    if (counts.borders > counts.cells) {
      return makeError(ErrorKind::kBadInput, "%s: %llu borders in %llu cells; %s", chunkPlace(file, index).c_str(),
                       ull{counts.borders}, ull{counts.cells}, kRemedy);
    }
    if (counts.borders > 0 && asset.levels.empty()) {
      return makeError(ErrorKind::kBadInput, "%s: borders, but the asset has no levels; %s",
                       chunkPlace(file, index).c_str(), kRemedy);
    }
    most += counts.borders;
  }
  if (asset.borderCount <= most) return {};
  return makeError(ErrorKind::kBadInput, "%s: border_count is %u, but the chunks hold %llu borders; %s", file.c_str(),
                   asset.borderCount, ull{most}, kRemedy);
}

}  // namespace

bool isBallWithin(const std::array<double, 3>& centre, double radius, const LevelGroup& group) {
  double squared = 0, size = group.radius;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double step = centre[axis] - group.centre[axis];
    squared += step * step;
    size = std::max(size, group.radius + std::abs(group.centre[axis]));
  }
  return std::sqrt(squared) + radius <= group.radius + kBallMargin * size;
}

Status checkLevels(const AssetContents& asset, std::span<const ChunkIndex> chunks, const std::string& file) {
  if (asset.levels.empty() != asset.groups.empty()) {
    return makeError(ErrorKind::kBadInput, "%s: %zu levels of chunks and %zu groups; there are both or neither; %s",
                     file.c_str(), asset.levels.size(), asset.groups.size(), kRemedy);
  }
  if (Status status = checkBorderCounts(asset, chunks, file); !status || asset.levels.empty()) return status;
  if (asset.levels.size() != chunks.size()) {
    return makeError(ErrorKind::kBadInput, "%s: levels of %zu chunks, there are %zu; %s", file.c_str(),
                     asset.levels.size(), chunks.size(), kRemedy);
  }
  for (uint32_t group = 0; group < asset.groups.size(); ++group) {
    if (Status status = checkGroup(asset.groups[group], groupPlace(file, group)); !status) return status;
  }
  for (uint32_t index = 0; index < asset.levels.size(); ++index) {
    const ChunkLevel& chunk = asset.levels[index];
    if (Status status = checkPlaceInGroups(asset, chunk, chunkPlace(file, index)); !status) return status;
    if (Status status = checkStep(asset, chunk, file); !status) return status;
    if (Status status = checkOrder(asset, index, file); !status) return status;
  }
  return checkForms(asset, file);
}

Status checkBorders(const ChunkContents& chunk, const std::string& place) {
  if (chunk.borderCells.size() != chunk.borderNumbers.size()) {
    return makeError(ErrorKind::kBadInput, "%s: %zu border_cells and %zu border_numbers; %s", place.c_str(),
                     chunk.borderCells.size(), chunk.borderNumbers.size(), kRemedy);
  }
  const std::vector<uint32_t>& cells = chunk.borderCells;
  const auto fall = std::adjacent_find(cells.begin(), cells.end(), std::greater_equal<uint32_t>());
  if (fall != cells.end()) {
    return makeError(ErrorKind::kBadInput, "%s: %u follows %u, cells must ascend; %s",
                     sectionPlace(place, SectionType::kBorderCells).c_str(), fall[1], fall[0], kRemedy);
  }
  if (!cells.empty() && cells.back() >= chunk.cellCount) {
    return makeError(ErrorKind::kBadInput, "%s: cell %u, there are %u; %s",
                     sectionPlace(place, SectionType::kBorderCells).c_str(), cells.back(), chunk.cellCount, kRemedy);
  }
  std::vector<uint32_t> numbers = chunk.borderNumbers;
  std::sort(numbers.begin(), numbers.end());
  const auto twice = std::adjacent_find(numbers.begin(), numbers.end());
  if (twice != numbers.end()) {
    return makeError(ErrorKind::kBadInput, "%s: border %u stands there twice; %s",
                     sectionPlace(place, SectionType::kBorderNumbers).c_str(), *twice, kRemedy);
  }
  if (numbers.empty()) return {};
  for (const CellRef ghost : chunk.ghostRefs) {
    if (!std::binary_search(numbers.begin(), numbers.end(), ghost)) continue;
    return makeError(ErrorKind::kBadInput, "%s: a ghost is border %u, which is a cell of the chunk; %s",
                     sectionPlace(place, SectionType::kGhostRefs).c_str(), ghost, kRemedy);
  }
  return {};
}

Status checkBorderRange(const AssetContents& asset, std::span<const uint32_t> borders, const std::string& place) {
  const auto highest = std::max_element(borders.begin(), borders.end());
  if (highest == borders.end() || *highest < asset.borderCount) return {};
  return makeError(ErrorKind::kBadInput, "%s: border %u, there are %u; %s", place.c_str(), *highest, asset.borderCount,
                   kRemedy);
}

}  // namespace froth
