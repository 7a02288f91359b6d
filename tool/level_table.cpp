// What the levels of detail of an asset hold.
#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "format/levels.h"
#include "tool/statistics.h"

namespace froth {
namespace {

struct LevelSum {
  uint64_t chunks = 0, cells = 0, liveCells = 0, borders = 0, bytes = 0, groups = 0;
  double leastError = 0, mostError = 0;  // of its groups
};

struct LevelSums {
  std::vector<LevelSum> levels;
  uint64_t floorChunks = 0, floorBytes = 0, bytes = 0;

  double floorShare() const { return bytes > 0 ? static_cast<double>(floorBytes) / static_cast<double>(bytes) : 0; }
};

LevelSums sumLevels(const AssetReader& asset) {
  const AssetContents& manifest = asset.manifest();
  LevelSums sums;
  sums.levels.resize(countLevels(manifest.levels));
  for (size_t i = 0; i < manifest.levels.size(); ++i) {
    LevelSum& level = sums.levels[manifest.levels[i].level];
    ++level.chunks;
    level.cells += manifest.chunks[i].cellCount;
    level.liveCells += manifest.chunks[i].liveCount;
    if (manifest.levels[i].in == kNoGroup) ++sums.floorChunks;
  }
  for (const SectionRecord& section : asset.sections()) {
    sums.bytes += section.storedSize;
    if (section.chunk == kSharedChunk) continue;
    const ChunkLevel& chunk = manifest.levels[section.chunk];
    sums.levels[chunk.level].bytes += section.storedSize;
    if (section.type == static_cast<uint32_t>(SectionType::kBorderNumbers)) {
      sums.levels[chunk.level].borders += section.rawSize / sizeof(uint32_t);
    }
    if (chunk.in == kNoGroup) sums.floorBytes += section.storedSize;
  }
  for (const LevelGroup& group : manifest.groups) {
    LevelSum& level = sums.levels[group.level];
    level.leastError = level.groups > 0 ? std::min(level.leastError, group.error) : group.error;
    level.mostError = std::max(level.mostError, group.error);
    ++level.groups;
  }
  return sums;
}

}  // namespace

void printLevels(const AssetReader& asset) {
  if (asset.manifest().levels.empty()) return;
  const LevelSums sums = sumLevels(asset);
  fmt::print("{:<8} {:>8} {:>12} {:>12} {:>10} {:>12} {:>8} {:>12} {:>12}\n", "level", "chunks", "cells", "live",
             "borders", "bytes", "groups", "least error", "most error");
  for (size_t i = 0; i < sums.levels.size(); ++i) {
    const LevelSum& level = sums.levels[i];
    fmt::print("{:<8} {:>8} {:>12} {:>12} {:>10} {:>12} {:>8} {:>12.4g} {:>12.4g}\n", i, level.chunks, level.cells,
               level.liveCells, level.borders, level.bytes, level.groups, level.leastError, level.mostError);
  }
  fmt::print("floor             {} chunks, {} bytes, {:.2f} % of the sections; {} borders in all levels\n",
             sums.floorChunks, sums.floorBytes, 100 * sums.floorShare(), asset.manifest().borderCount);
}

nlohmann::ordered_json levelsAsJson(const AssetReader& asset) {
  if (asset.manifest().levels.empty()) return nullptr;
  const LevelSums sums = sumLevels(asset);
  nlohmann::ordered_json levels = nlohmann::ordered_json::array();
  for (const LevelSum& level : sums.levels) {
    levels.push_back({{"chunks", level.chunks},
                      {"cells", level.cells},
                      {"liveCells", level.liveCells},
                      {"borders", level.borders},
                      {"bytes", level.bytes},
                      {"groups", level.groups},
                      {"errorRange", {level.leastError, level.mostError}}});
  }
  return {{"levels", levels},
          {"borders", asset.manifest().borderCount},
          {"floor", {{"chunks", sums.floorChunks}, {"bytes", sums.floorBytes}, {"share", sums.floorShare()}}}};
}

}  // namespace froth
