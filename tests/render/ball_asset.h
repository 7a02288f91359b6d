// Assets that no baker writes: balls without neighbours, in any chunks. K = 1, no lobes.
#pragma once

#include <cstdint>
#include <vector>

#include "format/asset_contents.h"

namespace froth::test {

struct BallCell {
  glm::vec3 site;
  float radius, density;
  glm::vec3 colour;  // offset from one half
};

// The cells in their order, chunkCells[i] of them in chunk i.
inline AssetContents makeBallAsset(const std::vector<BallCell>& cells, const std::vector<uint32_t>& chunkCells) {
  AssetContents contents;
  contents.detailCount = 1;
  contents.hasWalkGraph = false;
  contents.nearRatio = 0;
  contents.localBits = chunkCells.size() == 1 ? 32 : 15;
  size_t next = 0;
  for (const uint32_t count : chunkCells) {
    ChunkContents& chunk = contents.chunks.emplace_back();
    chunk.cellCount = chunk.liveCount = count;
    chunk.neighbourOffsets.assign(count + 1, 0);
    chunk.alphaCounts.assign(count, 0);
    chunk.orientations.assign(count, glm::vec4(0.8f, 0.6f, 0, 0));
    chunk.detailSites.assign(count, glm::vec2(0));
    for (uint32_t i = 0; i < count; ++i) {
      const BallCell& cell = cells[next++];
      chunk.sites.push_back(cell.site);
      chunk.radii.push_back(cell.radius);
      chunk.densities.push_back(cell.density);
      chunk.baseColours.push_back(cell.colour);
    }
  }
  return contents;
}

inline AssetContents makeBallAsset(const std::vector<BallCell>& cells) {
  return makeBallAsset(cells, {static_cast<uint32_t>(cells.size())});
}

}  // namespace froth::test
