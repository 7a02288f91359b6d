// Whether the sample with levels is a foam of levels: any of its cuts is a power diagram.
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "baker/graph/graph.h"
#include "level_sample.h"

namespace froth {
namespace {

// A cell of a cut by its number: those of different chunks are told apart by their place.
struct CutCell {
  glm::vec3 site;
  float radius;
  uint32_t chunk, local;
};

bool isRefined(const std::vector<uint8_t>& refined, uint32_t group) { return group != kNoGroup && refined[group] != 0; }

bool isDrawn(const ChunkLevel& level, const std::vector<uint8_t>& refined) {
  return (level.in == kNoGroup || isRefined(refined, level.in)) && !isRefined(refined, level.madeBy);
}

// Refines about half of the groups that may be refined, from the floor on.
std::vector<uint8_t> randomCut(const AssetContents& asset, std::mt19937& random) {
  std::vector<uint8_t> refined(asset.groups.size());
  for (uint32_t level = 3; level-- > 0;) {
    for (uint32_t group = 0; group < refined.size(); ++group) {
      if (asset.groups[group].level != level) continue;
      bool isAllowed = random() % 2 == 0;
      for (const ChunkLevel& chunk : asset.levels) {
        if (chunk.madeBy == group && chunk.in != kNoGroup) isAllowed = isAllowed && refined[chunk.in] != 0;
      }
      refined[group] = isAllowed ? 1 : 0;
    }
  }
  return refined;
}

glm::vec3 positionOf(const ChunkContents& chunk, uint32_t site) {
  return glm::vec3(glm::dvec3(chunk.origin[0], chunk.origin[1], chunk.origin[2]) + glm::dvec3(chunk.sites[site]));
}

std::vector<CutCell> cellsOf(const AssetContents& asset, const std::vector<uint8_t>& refined) {
  std::vector<CutCell> cells;
  for (uint32_t c = 0; c < asset.chunks.size(); ++c) {
    if (!isDrawn(asset.levels[c], refined)) continue;
    const ChunkContents& chunk = asset.chunks[c];
    for (uint32_t i = 0; i < chunk.cellCount; ++i) cells.push_back({positionOf(chunk, i), chunk.radii[i], c, i});
  }
  return cells;
}

// The neighbours of a cell as its chunk names them: indices into the cut's cells.
std::vector<uint32_t> namedNeighbours(const AssetContents& asset, const CutCell& cell,
                                      const std::map<std::pair<uint32_t, uint32_t>, uint32_t>& own,
                                      const std::map<uint32_t, uint32_t>& byBorder) {
  const ChunkContents& chunk = asset.chunks[cell.chunk];
  std::vector<uint32_t> named;
  for (uint32_t at = chunk.neighbourOffsets[cell.local]; at < chunk.neighbourOffsets[cell.local + 1]; ++at) {
    const uint32_t site = chunk.neighbours[at];
    const bool isOwn = site < chunk.cellCount;
    named.push_back(isOwn ? own.at({cell.chunk, site}) : byBorder.at(chunk.ghostRefs[site - chunk.cellCount]));
  }
  std::sort(named.begin(), named.end());
  return named;
}

void expectPowerDiagram(const AssetContents& asset, const std::vector<uint8_t>& refined) {
  const std::vector<CutCell> cells = cellsOf(asset, refined);
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> own;
  std::map<uint32_t, uint32_t> byBorder;
  std::vector<glm::vec3> sites;
  std::vector<float> radii;
  for (const CutCell& cell : cells) {
    const uint32_t index = static_cast<uint32_t>(own.size());
    own[{cell.chunk, cell.local}] = index;
    const ChunkContents& chunk = asset.chunks[cell.chunk];
    const auto border = std::lower_bound(chunk.borderCells.begin(), chunk.borderCells.end(), cell.local);
    if (border != chunk.borderCells.end() && *border == cell.local) {
      const uint32_t number = chunk.borderNumbers[static_cast<size_t>(border - chunk.borderCells.begin())];
      EXPECT_TRUE(byBorder.emplace(number, index).second) << "border " << number << " is drawn twice";
    }
    sites.push_back(cell.site);
    radii.push_back(cell.radius);
  }
  const Result<RegularTriangulation> whole = triangulateRegular(sites, radii);
  ASSERT_TRUE(whole);
  for (uint32_t i = 0; i < cells.size(); ++i) {
    const auto row = neighboursOf(whole->graph, i);
    EXPECT_EQ(namedNeighbours(asset, cells[i], own, byBorder), std::vector<uint32_t>(row.begin(), row.end()))
        << "cell " << cells[i].local << " of chunk " << cells[i].chunk;
  }
}

TEST(LevelSample, GetsCoarserByLevel) {
  const AssetContents asset = makeLevelSample();
  uint32_t cells[3] = {};
  for (size_t c = 0; c < asset.chunks.size(); ++c) cells[asset.levels[c].level] += asset.chunks[c].cellCount;
  EXPECT_LT(cells[1], cells[0]);
  EXPECT_LT(cells[2], cells[1]);
  EXPECT_EQ(asset.chunks.size(), 18u);
  EXPECT_EQ(asset.groups.size(), 6u);
}

TEST(LevelSample, AnyCutIsThePowerDiagramOfItsCells) {
  for (const uint32_t seed : {1u, 2u}) {
    const AssetContents asset = makeLevelSample({.cellCount = 600, .seed = seed});
    std::mt19937 random(seed);
    for (int trial = 0; trial < 6; ++trial) expectPowerDiagram(asset, randomCut(asset, random));
  }
}

}  // namespace
}  // namespace froth
