#include "tests/levels/level_scene.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"
#include "tests/render/split_asset.h"

namespace froth::test {
namespace {

constexpr uint32_t kCells = 400, kSeed = 91;
constexpr uint32_t kDetails = 4, kLobes = 2;

// Another look of the same cells.
AssetContents recolour(const AssetContents& whole, uint32_t level) {
  AssetContents other = whole;
  ChunkContents& chunk = other.chunks[0];
  for (glm::vec3& colour : chunk.lobeColours) {
    colour = level == 1 ? glm::vec3(colour.z, colour.x, colour.y) : glm::vec3(-colour.x, colour.z, -colour.y);
  }
  std::reverse(chunk.densities.begin(), chunk.densities.begin() + chunk.liveCount / (level + 1));
  return other;
}

using SiteKey = std::tuple<float, float, float, float>;
SiteKey keyOf(const ChunkContents& chunk, uint32_t site) {
  const glm::vec3& place = chunk.sites[site];
  return {place.x, place.y, place.z, chunk.radii[site]};
}

// A chunk whose ghosts name borders, in their order.
void nameBorders(ChunkContents& chunk, const std::vector<uint32_t>& ghostNumbers) {
  std::vector<uint32_t> order(chunk.ghostCount), places(chunk.ghostCount);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return ghostNumbers[a] < ghostNumbers[b]; });
  const ChunkContents before = chunk;
  for (uint32_t i = 0; i < chunk.ghostCount; ++i) {
    places[order[i]] = i;
    chunk.ghostRefs[i] = ghostNumbers[order[i]];
    chunk.sites[chunk.cellCount + i] = before.sites[chunk.cellCount + order[i]];
    chunk.radii[chunk.cellCount + i] = before.radii[chunk.cellCount + order[i]];
  }
  for (uint32_t& neighbour : chunk.neighbours) {
    if (neighbour >= chunk.cellCount) neighbour = chunk.cellCount + places[neighbour - chunk.cellCount];
  }
}

LevelScene makeScene() {
  LevelScene scene;
  scene.whole[0] = bakeForTest(makeRandomFoam(kCells, kDetails, kLobes, kSeed));
  for (const uint32_t level : {1u, 2u}) scene.whole[level] = recolour(scene.whole[0], level);
  scene.levels = scene.whole[0];
  AssetContents& levels = scene.levels;
  levels.chunks.clear();
  const uint32_t counts[] = {2 * LevelScene::kCoarseChunks, LevelScene::kCoarseChunks, 1};
  for (const uint32_t level : {2u, 1u, 0u}) {
    const AssetContents split = splitAsset(scene.whole[level], counts[level], 0);
    levels.localBits = split.localBits;
    for (uint32_t i = 0; i < counts[level]; ++i) {
      levels.chunks.push_back(split.chunks[i]);
      const uint32_t group = level == 0 ? 1 + i / 2 : level == 1 ? 0 : kNoGroup;
      levels.levels.push_back({level, level == 0 ? kNoGroup : level == 1 ? 1 + i : 0, level == 2 ? 0 : group});
    }
  }
  levels.levels[0] = {2, 0, kNoGroup};
  for (uint32_t group = 0; group <= LevelScene::kCoarseChunks; ++group) {
    levels.groups.push_back({{0, 0, 3}, 3, group == 0 ? 2.0 : 1.0, group == 0 ? 1u : 0u});
  }

  std::map<SiteKey, uint32_t> cellOf;
  const ChunkContents& whole = scene.whole[0].chunks[0];
  for (uint32_t cell = 0; cell < whole.cellCount; ++cell) cellOf[keyOf(whole, cell)] = cell;
  EXPECT_EQ(cellOf.size(), whole.cellCount) << "sites are not unique";
  std::set<uint32_t> borders;
  for (const ChunkContents& chunk : levels.chunks) {
    std::vector<uint32_t>& cells = scene.cells.emplace_back();
    for (uint32_t site = 0; site < chunk.sites.size(); ++site) {
      const uint32_t cell = cellOf.at(keyOf(chunk, site));
      if (site < chunk.cellCount) {
        cells.push_back(cell);
      } else {
        borders.insert(cell);
      }
    }
  }
  const std::vector<uint32_t> numbered(borders.begin(), borders.end());
  levels.borderCount = static_cast<uint32_t>(numbered.size());
  const auto numberOf = [&](uint32_t cell) {
    return static_cast<uint32_t>(std::lower_bound(numbered.begin(), numbered.end(), cell) - numbered.begin());
  };
  for (size_t i = 0; i < levels.chunks.size(); ++i) {
    ChunkContents& chunk = levels.chunks[i];
    for (uint32_t local = 0; local < chunk.cellCount; ++local) {
      if (borders.count(scene.cells[i][local]) == 0) continue;
      chunk.borderCells.push_back(local);
      chunk.borderNumbers.push_back(numberOf(scene.cells[i][local]));
    }
    std::vector<uint32_t> ghostNumbers;
    for (uint32_t ghost = 0; ghost < chunk.ghostCount; ++ghost) {
      ghostNumbers.push_back(numberOf(cellOf.at(keyOf(chunk, chunk.cellCount + ghost))));
    }
    nameBorders(chunk, ghostNumbers);
  }
  return scene;
}

template <class T>
void copyCell(const std::vector<T>& from, uint32_t cell, uint32_t perCell, std::vector<T>& to) {
  if (from.empty()) return;
  std::copy_n(from.begin() + std::ptrdiff_t{cell} * perCell, perCell, to.begin() + std::ptrdiff_t{cell} * perCell);
}

}  // namespace

std::vector<uint32_t> LevelScene::cut(uint32_t refined) const {
  std::vector<uint32_t> chunks;
  for (uint32_t i = 0; i < kCoarseChunks; ++i) {
    if ((refined >> i & 1) == 0) chunks.push_back(1 + i);
  }
  for (uint32_t i = 0; i < kCoarseChunks; ++i) {
    if ((refined >> i & 1) != 0) chunks.insert(chunks.end(), {5 + 2 * i, 6 + 2 * i});
  }
  return chunks;
}

AssetContents LevelScene::mixed(const std::vector<uint32_t>& chunks) const {
  AssetContents result = whole[0];
  ChunkContents& made = result.chunks[0];
  for (const uint32_t number : chunks) {
    const ChunkContents& from = whole[levels.levels[number].level].chunks[0];
    for (const uint32_t cell : cells[number]) {
      if (cell >= from.liveCount) continue;
      copyCell(from.densities, cell, 1, made.densities);
      copyCell(from.lobeColours, cell, kDetails * kLobes, made.lobeColours);
    }
  }
  return result;
}

const LevelScene& levelScene() {
  static const LevelScene scene = makeScene();
  return scene;
}

}  // namespace froth::test
