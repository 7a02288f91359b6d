#include "sample_asset.h"

#include <algorithm>
#include <random>

namespace froth {
namespace {

// std::mt19937's sequence is fixed by the standard, that of the distributions is not.
class Random {
 public:
  float operator()() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }  // [0, 1)
  template <class Vector>
  void fill(std::vector<Vector>& array, size_t size) {
    array.resize(size);
    float* numbers = reinterpret_cast<float*>(array.data());
    for (size_t i = 0; i < size * (sizeof(Vector) / sizeof(float)); ++i) numbers[i] = (*this)() - 0.5f;
  }

 private:
  std::mt19937 engine_{7};
};

struct Cell {
  CellRef reference;
  glm::dvec3 site;  // in the world
  double radius;
  bool isLive;
};

void fillArrays(ChunkContents& chunk, const SampleOptions& options, Random& random) {
  const size_t details = size_t{chunk.liveCount} * options.detailCount;
  random.fill(chunk.sites, chunk.cellCount);
  random.fill(chunk.radii, chunk.cellCount);
  for (float& radius : chunk.radii) radius += 1;
  random.fill(chunk.densities, chunk.liveCount);
  for (float& density : chunk.densities) density += 2;
  random.fill(chunk.orientations, chunk.liveCount);
  for (glm::vec4& orientation : chunk.orientations) orientation = glm::normalize(orientation);
  random.fill(chunk.detailSites, details);
  if (options.hasHeights) random.fill(chunk.detailHeights, details);
  random.fill(chunk.lobeAxes, details * options.lobeCount);
  random.fill(chunk.lobeColours, details * options.lobeCount);
}

std::vector<Cell> listCells(const AssetContents& asset) {
  std::vector<Cell> cells;
  for (uint32_t c = 0; c < asset.chunks.size(); ++c) {
    const ChunkContents& chunk = asset.chunks[c];
    for (uint32_t i = 0; i < chunk.cellCount; ++i) {
      const CellRef reference = asset.localBits == 32 ? i : (c << asset.localBits) | i;
      const glm::dvec3 origin(chunk.origin[0], chunk.origin[1], chunk.origin[2]);
      cells.push_back({reference, origin + glm::dvec3(chunk.sites[i]), chunk.radii[i], i < chunk.liveCount});
    }
  }
  return cells;
}

double planeDistance(const Cell& a, const Cell& b) {
  const glm::dvec3 d = b.site - a.site;
  return 0.5 * (glm::dot(d, d) + a.radius * a.radius - b.radius * b.radius) / glm::length(d);
}

// The row of cell `a`; its alpha neighbours come first, each part nearest plane first.
std::vector<CellRef> makeRow(const std::vector<Cell>& cells, size_t a, bool hasWalkGraph,
                             uint32_t& alphaCount) {
  std::vector<std::pair<double, CellRef>> alpha, others;
  for (size_t b = 0; b < cells.size(); ++b) {
    if (b == a) continue;
    const bool isAlpha = cells[a].isLive && (a + b) % 2 == 1;
    (isAlpha ? alpha : others).emplace_back(planeDistance(cells[a], cells[b]), cells[b].reference);
  }
  std::sort(alpha.begin(), alpha.end());
  std::sort(others.begin(), others.end());
  alphaCount = static_cast<uint32_t>(alpha.size());
  std::vector<CellRef> row;
  for (const auto& [distance, reference] : alpha) row.push_back(reference);
  if (hasWalkGraph)
    for (const auto& [distance, reference] : others) row.push_back(reference);
  return row;
}

void fillGraph(AssetContents& asset) {
  const std::vector<Cell> cells = listCells(asset);
  size_t cell = 0;
  for (ChunkContents& chunk : asset.chunks) {
    chunk.neighbourOffsets.assign(1, 0);
    for (uint32_t i = 0; i < chunk.cellCount; ++i, ++cell) {
      uint32_t alphaCount = 0;
      const std::vector<CellRef> row = makeRow(cells, cell, asset.hasWalkGraph, alphaCount);
      chunk.neighbours.insert(chunk.neighbours.end(), row.begin(), row.end());
      chunk.neighbourOffsets.push_back(static_cast<uint32_t>(chunk.neighbours.size()));
      if (i < chunk.liveCount) chunk.alphaCounts.push_back(alphaCount);
    }
  }
}

}  // namespace

AssetContents makeSampleAsset(const SampleOptions& options) {
  AssetContents asset;
  asset.detailCount = options.detailCount;
  asset.lobeCount = options.lobeCount;
  asset.localBits = options.localBits;
  asset.hasWalkGraph = options.hasWalkGraph;
  asset.detailSharpness = 9.5f;
  asset.nearRatio = 3.0f;
  asset.nearDepth = 0.25f;
  asset.source = "sample";
  asset.statistics = {100, 7, 2, 3, 4, 50, 25};
  asset.hasStartView = true;
  asset.startView.worldFromCamera = {1, 0, 0, 0.1, 0, 1, 0, 0.2, 0, 0, 1, -3};
  asset.flightPath.assign(2, asset.startView);
  asset.flightPath[1].tanHalfFovY = 0.75;
  Random random;
  for (uint32_t c = 0; c < options.chunkCount; ++c) {
    ChunkContents chunk;
    chunk.origin = {1.5 * c, -0.25 * c, 1e6};
    chunk.cellCount = options.cellsPerChunk;
    chunk.liveCount = options.cellsPerChunk - options.cellsPerChunk / 3;
    fillArrays(chunk, options, random);
    asset.chunks.push_back(std::move(chunk));
  }
  fillGraph(asset);
  return asset;
}

}  // namespace froth
