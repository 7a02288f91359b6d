// How the lobes of a chunk belong to its detail sites.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "format/asset_contents.h"
#include "format/lattice.h"

namespace froth {

// Lobes of detail site `detail`; `lobeCount`: M of the asset.
inline uint32_t lobeCountOf(const ChunkContents& chunk, uint32_t lobeCount, size_t detail) {
  return chunk.lobeCounts.empty() ? lobeCount : chunk.lobeCounts[detail];
}

// Lobes of all detail sites, by their counts.
inline size_t countLobes(const AssetContents& asset, const ChunkContents& chunk) {
  if (chunk.lobeCounts.empty()) return size_t{chunk.liveCount} * asset.detailCount * asset.lobeCount;
  return std::accumulate(chunk.lobeCounts.begin(), chunk.lobeCounts.end(), size_t{0});
}

// The step of the colour lattice for each lobe.
inline std::vector<float> lobeUnits(const AssetContents& asset, const ChunkContents& chunk) {
  std::vector<float> units;
  units.reserve(chunk.lobeColours.size());
  for (size_t detail = 0; detail < size_t{chunk.liveCount} * asset.detailCount; ++detail) {
    units.insert(units.end(), lobeCountOf(chunk, asset.lobeCount, detail),
                 unitOf(asset.quantization.colourStep, chunk.colourScales, detail / asset.detailCount));
  }
  return units;
}

}  // namespace froth
