// Small foams with levels, and the cells of a cut as a reader of the asset sees them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "baker/bake/bake.h"
#include "baker/synth/synth.h"
#include "tests/bake/random_foam.h"

namespace froth {

inline BakeResult bakeLevels(const Foam& foam, uint32_t chunkCells, const char* preset = "exact") {
  BakeOptions options;
  options.preset = preset;
  options.knobs = *presetKnobs(preset);
  options.chunkCells = chunkCells;
  options.levels = true;
  options.measure = false;
  Result<BakeResult> result = bakeFoam(foam, options);
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

inline bool isDrawn(const AssetContents& contents, uint32_t chunk, const std::vector<uint8_t>& isRefined) {
  const ChunkLevel& place = contents.levels[chunk];
  return (place.in == kNoGroup || isRefined[place.in]) && (place.madeBy == kNoGroup || !isRefined[place.madeBy]);
}

// The cells of the drawn chunks, one after the other.
struct DrawnCells {
  std::vector<glm::vec3> sites;  // world coordinates
  std::vector<float> radii;
  std::vector<uint8_t> isLive;
  std::vector<std::vector<uint32_t>> rows, alphaRows;  // ascending; the latter of live cells
  uint64_t faults = 0;  // borders drawn twice, ghosts of cells that are not drawn, or that lie elsewhere
};

inline glm::vec3 worldSite(const ChunkContents& chunk, uint32_t local) {
  return glm::vec3(glm::dvec3(chunk.origin[0], chunk.origin[1], chunk.origin[2]) + glm::dvec3(chunk.sites[local]));
}

inline DrawnCells drawCut(const AssetContents& contents, const std::vector<uint8_t>& isRefined) {
  constexpr uint32_t kNone = 0xffffffff;
  DrawnCells drawn;
  std::vector<uint32_t> cellOfBorder(contents.borderCount, kNone);
  std::vector<std::pair<const ChunkContents*, uint32_t>> chunks;  // and the number of its first cell
  for (uint32_t index = 0; index < contents.chunks.size(); ++index) {
    if (!isDrawn(contents, index, isRefined)) continue;
    const ChunkContents& chunk = contents.chunks[index];
    const auto first = static_cast<uint32_t>(drawn.sites.size());
    chunks.emplace_back(&chunk, first);
    for (uint32_t local = 0; local < chunk.cellCount; ++local) drawn.sites.push_back(worldSite(chunk, local));
    drawn.radii.insert(drawn.radii.end(), chunk.radii.begin(), chunk.radii.begin() + chunk.cellCount);
    for (size_t k = 0; k < chunk.borderCells.size(); ++k) {
      uint32_t& cell = cellOfBorder[chunk.borderNumbers[k]];
      drawn.faults += cell != kNone;
      cell = first + chunk.borderCells[k];
    }
  }
  for (const auto& [chunk, first] : chunks) {
    std::vector<uint32_t> cells;  // of sites
    for (uint32_t local = 0; local < chunk->cellCount; ++local) cells.push_back(first + local);
    for (uint32_t ghost = 0; ghost < chunk->ghostCount; ++ghost) {
      const uint32_t cell = cellOfBorder[chunk->ghostRefs[ghost]], local = chunk->cellCount + ghost;
      cells.push_back(cell);
      drawn.faults +=
          cell == kNone || drawn.sites[cell] != worldSite(*chunk, local) || drawn.radii[cell] != chunk->radii[local];
    }
    for (uint32_t local = 0; local < chunk->cellCount; ++local) {
      std::vector<uint32_t>& row = drawn.rows.emplace_back();
      for (uint32_t k = chunk->neighbourOffsets[local]; k < chunk->neighbourOffsets[local + 1]; ++k) {
        row.push_back(cells[chunk->neighbours[k]]);
      }
      std::vector<uint32_t>& alpha = drawn.alphaRows.emplace_back(row);
      drawn.isLive.push_back(local < chunk->liveCount);
      alpha.resize(local < chunk->liveCount ? chunk->alphaCounts[local] : 0);
      std::sort(row.begin(), row.end());
      std::sort(alpha.begin(), alpha.end());
    }
  }
  return drawn;
}

}  // namespace froth
