// An asset of very many chunks, and the same cells in one.
#pragma once

#include "tests/format/sample_asset.h"

namespace froth {

// Balls apart from each other, on the plane z = 1e6 + 8.
inline AssetContents makeOneCellChunks(uint32_t count) {
  constexpr uint32_t kRowLength = 60;
  AssetContents asset = makeSampleAsset({.cellsPerChunk = 1, .localBits = 8, .hasHeights = false});
  ChunkContents cell = asset.chunks[0];
  asset.chunks.clear();
  cell.sites[0] = {0.25f, 0.5f, 0};
  cell.radii[0] = 0.125f;
  cell.densities[0] = 8;
  for (uint32_t i = 0; i < count; ++i) {
    const double x = i % kRowLength, y = i / kRowLength % kRowLength;
    cell.origin = {(x - 30) / 4, (y - 30) / 4, 1e6 + 8};
    asset.chunks.push_back(cell);
  }
  return asset;
}

inline AssetContents joinChunks(const AssetContents& parted) {
  const auto append = [](auto& all, const auto& some) { all.insert(all.end(), some.begin(), some.end()); };
  AssetContents joined = parted;
  joined.localBits = 32;
  ChunkContents whole;
  whole.origin = {0, 0, 1e6 + 8};
  whole.neighbourOffsets = {0};
  for (const ChunkContents& chunk : parted.chunks) {
    const glm::dvec3 shift(chunk.origin[0], chunk.origin[1], chunk.origin[2] - whole.origin[2]);
    whole.sites.push_back(glm::vec3(glm::dvec3(chunk.sites[0]) + shift));
    whole.neighbourOffsets.push_back(0);
    append(whole.radii, chunk.radii);
    append(whole.alphaCounts, chunk.alphaCounts);
    append(whole.densities, chunk.densities);
    append(whole.orientations, chunk.orientations);
    append(whole.detailSites, chunk.detailSites);
    append(whole.lobeAxes, chunk.lobeAxes);
    append(whole.lobeColours, chunk.lobeColours);
  }
  whole.cellCount = whole.liveCount = static_cast<uint32_t>(whole.radii.size());
  joined.chunks = {whole};
  return joined;
}

}  // namespace froth
