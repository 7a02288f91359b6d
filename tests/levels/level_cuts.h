// Cuts of the sample with levels of detail (tests/format/level_sample.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/format/level_sample.h"

namespace froth::test {

inline const AssetContents& levelSample() {
  static const AssetContents sample = makeLevelSample();
  return sample;
}

// [group] what docs/STREAMING.md calls a cut: each group is refined if `wants` says so and all of its coarse chunks may
// go for it.
template <class Wants>
std::vector<bool> refineGroups(const AssetContents& asset, const Wants& wants) {
  std::vector<bool> isRefined(asset.groups.size(), false);
  std::vector<uint32_t> order(asset.groups.size());
  for (uint32_t group = 0; group < order.size(); ++group) order[group] = group;
  std::ranges::stable_sort(order,
                           [&](uint32_t a, uint32_t b) { return asset.groups[a].level > asset.groups[b].level; });
  for (const uint32_t group : order) {
    const auto stays = [&](const ChunkLevel& chunk) {
      return chunk.madeBy == group && chunk.in != kNoGroup && !isRefined[chunk.in];
    };
    isRefined[group] = wants(group) && std::ranges::none_of(asset.levels, stays);
  }
  return isRefined;
}

// The chunks that are drawn, ascending.
template <class Wants>
std::vector<uint32_t> cutWhere(const Wants& wants) {
  const AssetContents& asset = levelSample();
  const std::vector<bool> isRefined = refineGroups(asset, wants);
  std::vector<uint32_t> cut;
  for (uint32_t chunk = 0; chunk < asset.levels.size(); ++chunk) {
    const ChunkLevel& level = asset.levels[chunk];
    const bool isOpen = level.in == kNoGroup || isRefined[level.in];
    if (isOpen && (level.madeBy == kNoGroup || !isRefined[level.madeBy])) cut.push_back(chunk);
  }
  return cut;
}

inline std::vector<uint32_t> floorCut() {
  return cutWhere([](uint32_t) { return false; });
}
inline std::vector<uint32_t> finestCut() {
  return cutWhere([](uint32_t) { return true; });
}
inline std::vector<uint32_t> randomCut(std::mt19937& random) {
  return cutWhere([&](uint32_t) { return random() % 4 != 0; });
}

// The cells of a cut alone: what it should look like.
inline AssetContents contentsOf(const std::vector<uint32_t>& cut) {
  AssetContents contents = levelSample();
  contents.chunks.clear();
  for (const uint32_t chunk : cut) contents.chunks.push_back(levelSample().chunks[chunk]);
  return contents;
}

}  // namespace froth::test
