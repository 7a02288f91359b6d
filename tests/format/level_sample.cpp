#include "level_sample.h"

#include <algorithm>
#include <map>
#include <set>

#include "format/graph_rows.h"
#include "level_foams.h"

namespace froth {
namespace {

constexpr uint32_t kDetailCount = 2;

// Border numbers by the cells' numbers: of all cells that are a ghost in some level.
using Borders = std::map<uint32_t, uint32_t>;

// Level 0 halves its groups by z, into two chunks each.
uint32_t chunkKey(const LevelCell& cell, uint32_t level) {
  if (level == 0) return 2 * cell.in + (cell.site.z > 0.1f ? 1u : 0u);
  return level == 1 ? cell.in * kLevelSampleGroups[0] + cell.madeBy : cell.madeBy;
}

// The chunks of one level.
class ChunkMaker {
 public:
  ChunkMaker(const LevelFoam& foam, uint32_t level, const Borders& borders)
      : foam_(foam), level_(level), borders_(borders) {
    const SiteArrays arrays = arraysOf(foam.cells);
    alpha_ = computeAlphaComplex(arrays.sites, arrays.radii, foam.triangulation);
  }

  void make(AssetContents& asset) const {
    std::map<uint32_t, std::vector<uint32_t>> chunks;
    for (uint32_t i = 0; i < foam_.cells.size(); ++i) chunks[chunkKey(foam_.cells[i], level_)].push_back(i);
    for (auto& [key, cells] : chunks) {
      std::stable_partition(cells.begin(), cells.end(), [&](uint32_t i) { return isLive(i); });
      asset.chunks.push_back(makeChunk(cells));
      const LevelCell& first = foam_.cells[cells.front()];
      asset.levels.push_back({.level = level_, .madeBy = first.madeBy, .in = first.in});
    }
  }

 private:
  bool isLive(uint32_t i) const { return foam_.cells[i].density > 0 && !alpha_.isEmpty[i]; }

  ChunkContents makeChunk(const std::vector<uint32_t>& cells) const {
    ChunkContents chunk;
    const glm::vec3 origin = foam_.cells[cells.front()].site;
    chunk.origin = {origin.x, origin.y, origin.z};
    std::map<uint32_t, uint32_t> local;  // of the level's cells
    for (const uint32_t i : cells) addSite(chunk, i, local);
    chunk.cellCount = static_cast<uint32_t>(cells.size());
    std::map<uint32_t, uint32_t> ghosts;  // by border number
    for (const uint32_t i : cells) {
      for (const uint32_t j : foam_.neighbours(i)) {
        if (!local.contains(j)) ghosts[borders_.at(foam_.cells[j].number)] = j;
      }
    }
    for (const auto& [border, i] : ghosts) {
      addSite(chunk, i, local);
      chunk.ghostRefs.push_back(border);
    }
    chunk.ghostCount = static_cast<uint32_t>(ghosts.size());
    fillGraph(chunk, cells, local);
    for (uint32_t cell = 0; cell < cells.size(); ++cell) {
      const auto border = borders_.find(foam_.cells[cells[cell]].number);
      if (border == borders_.end()) continue;
      chunk.borderCells.push_back(cell);
      chunk.borderNumbers.push_back(border->second);
    }
    for (const uint32_t i : cells) {
      if (isLive(i)) fillCell(chunk, foam_.cells[i]);
    }
    return chunk;
  }

  void addSite(ChunkContents& chunk, uint32_t i, std::map<uint32_t, uint32_t>& local) const {
    local[i] = static_cast<uint32_t>(chunk.sites.size());
    const glm::vec3 origin(static_cast<float>(chunk.origin[0]), static_cast<float>(chunk.origin[1]),
                           static_cast<float>(chunk.origin[2]));
    chunk.sites.push_back(foam_.cells[i].site - origin);  // exact: on the lattice
    chunk.radii.push_back(foam_.cells[i].radius);
  }

  void fillGraph(ChunkContents& chunk, const std::vector<uint32_t>& cells,
                 const std::map<uint32_t, uint32_t>& local) const {
    chunk.neighbourOffsets.push_back(0);
    for (const uint32_t i : cells) {
      const auto alpha = neighboursOf(alpha_.graph, i);
      if (isLive(i)) {
        chunk.alphaCounts.push_back(static_cast<uint32_t>(alpha.size()));
        for (const uint32_t j : alpha) chunk.neighbours.push_back(local.at(j));
      }
      for (const uint32_t j : foam_.neighbours(i)) {
        const bool isAlpha = isLive(i) && std::binary_search(alpha.begin(), alpha.end(), j);
        if (!isAlpha) chunk.neighbours.push_back(local.at(j));
      }
      chunk.neighbourOffsets.push_back(static_cast<uint32_t>(chunk.neighbours.size()));
    }
    chunk.liveCount = static_cast<uint32_t>(chunk.alphaCounts.size());
    sortGraphRows(chunk, 0, chunk.cellCount);
  }

  static void fillCell(ChunkContents& chunk, const LevelCell& cell) {
    LevelRandom random(cell.number);
    chunk.densities.push_back(cell.density);
    chunk.orientations.push_back(
        glm::normalize(glm::vec4(1 + random(), random() - 0.5f, random() - 0.5f, random() - 0.5f)));
    const auto byteColour = [](float value) { return colourOfByte(static_cast<uint8_t>(255 * value)); };
    const glm::vec3 colour(byteColour(cell.colour.x), byteColour(cell.colour.y), byteColour(cell.colour.z));
    chunk.cellColours.push_back(colour);
    for (uint32_t detail = 0; detail < kDetailCount; ++detail) {
      const float side = detail == 0 ? -0.5f : 0.5f;
      chunk.detailSites.emplace_back(side, 0.2f * side);
      chunk.baseColours.push_back(colour - 0.5f + 0.1f * side);
      chunk.lobeAxes.emplace_back(2 * random(), 1, side);
      chunk.lobeColours.emplace_back(0.1f * side, 0, 0.05f);
    }
  }

  const LevelFoam& foam_;
  uint32_t level_;
  const Borders& borders_;
  AlphaComplex alpha_;
};

Borders numberBorders(const std::vector<LevelFoam>& levels) {
  std::set<uint32_t> numbers;
  for (uint32_t level = 0; level < levels.size(); ++level) {
    const LevelFoam& foam = levels[level];
    for (uint32_t i = 0; i < foam.cells.size(); ++i) {
      for (const uint32_t j : foam.neighbours(i)) {
        if (chunkKey(foam.cells[i], level) != chunkKey(foam.cells[j], level)) numbers.insert(foam.cells[j].number);
      }
    }
  }
  Borders borders;
  for (const uint32_t number : numbers) borders.emplace(number, static_cast<uint32_t>(borders.size()));
  return borders;
}

// Errors that grow by level.
void fillGroups(AssetContents& asset) {
  for (uint32_t level = 0; level < std::size(kLevelSampleGroups); ++level) {
    for (uint32_t i = 0; i < kLevelSampleGroups[level]; ++i) {
      const double error = 0.01 * (1u << level) * (1 + 0.1 * i);
      asset.groups.push_back({.error = error, .level = level});
    }
  }
}

// Grows the ball of a group around a ball.
void include(LevelGroup& group, const glm::dvec3& centre, double radius) {
  const glm::dvec3 own(group.centre[0], group.centre[1], group.centre[2]);
  group.radius = std::max(group.radius, glm::length(centre - own) + radius);
}

void fillBalls(AssetContents& asset) {
  std::vector<glm::dvec3> sums(asset.groups.size());
  std::vector<uint32_t> counts(asset.groups.size());
  const auto forEachLive = [&](auto visit) {
    for (size_t c = 0; c < asset.chunks.size(); ++c) {
      const ChunkContents& chunk = asset.chunks[c];
      const glm::dvec3 origin(chunk.origin[0], chunk.origin[1], chunk.origin[2]);
      for (const uint32_t group : {asset.levels[c].in, asset.levels[c].madeBy}) {
        for (uint32_t i = 0; group != kNoGroup && i < chunk.liveCount; ++i) {
          visit(group, origin + glm::dvec3(chunk.sites[i]), chunk.radii[i]);
        }
      }
    }
  };
  forEachLive([&](uint32_t group, const glm::dvec3& site, float) {
    sums[group] += site;
    ++counts[group];
  });
  for (size_t i = 0; i < asset.groups.size(); ++i) {
    const glm::dvec3 mean = sums[i] / static_cast<double>(std::max(counts[i], 1u));
    asset.groups[i].centre = {mean.x, mean.y, mean.z};
  }
  forEachLive([&](uint32_t group, const glm::dvec3& site, float radius) {
    include(asset.groups[group], site, double{radius});
  });
  for (const ChunkLevel& chunk : asset.levels) {  // two levels of groups: one step up is enough
    if (chunk.madeBy == kNoGroup || chunk.in == kNoGroup) continue;
    const LevelGroup& below = asset.groups[chunk.madeBy];
    include(asset.groups[chunk.in], {below.centre[0], below.centre[1], below.centre[2]}, below.radius);
  }
}

}  // namespace

AssetContents makeLevelSample(const LevelSampleOptions& options) {
  const std::vector<LevelFoam> levels = makeLevelFoams(options);
  const Borders borders = numberBorders(levels);
  AssetContents asset;
  asset.detailCount = kDetailCount;
  asset.lobeCount = 1;
  asset.localBits = 20;
  asset.source = "levels";
  asset.quantization.positionStep = kLevelSampleStep;
  asset.borderCount = static_cast<uint32_t>(borders.size());
  for (uint32_t level = static_cast<uint32_t>(levels.size()); level-- > 0;) {
    ChunkMaker(levels[level], level, borders).make(asset);
  }
  fillGroups(asset);
  fillBalls(asset);
  return asset;
}

}  // namespace froth
