// Numbers, points and graphs on which codecs are tried. The same on every machine.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <set>
#include <span>
#include <vector>

#include "format/asset_contents.h"
#include "format/graph_rows.h"
#include "format/section_codec.h"

namespace froth {

template <class T>
std::span<const uint8_t> bytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size() * sizeof(T)};
}

inline std::vector<uint8_t> randomBytes(size_t count) {
  std::mt19937 random(7);
  std::vector<uint8_t> bytes(count);
  for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random() >> 11);
  return bytes;
}

inline std::vector<LatticePoint> randomPoints(size_t count, uint32_t bits) {
  std::mt19937 random(11);
  std::vector<LatticePoint> points(count);
  for (LatticePoint& point : points) {
    for (int32_t& coordinate : point) coordinate = static_cast<int32_t>(random() >> (32 - bits)) - 1000;
  }
  return points;
}

// A chunk whose last quarter of cells is not live, with half as many ghosts as cells and random pairs of near
// indices.
inline ChunkContents randomGraph(uint32_t cellCount, bool hasWalkGraph) {
  std::mt19937 random(13);
  ChunkContents chunk;
  chunk.cellCount = cellCount;
  chunk.liveCount = cellCount - cellCount / 4;
  chunk.ghostCount = cellCount / 2;
  const uint32_t siteCount = chunk.cellCount + chunk.ghostCount;
  const auto unit = [&random] { return static_cast<float>(random() % 4096) / 4096; };
  for (uint32_t i = 0; i < siteCount; ++i) {
    chunk.sites.emplace_back(unit(), unit(), unit());
    chunk.radii.push_back(0.01f + 0.3f * unit());
  }
  std::vector<std::set<uint32_t>> alpha(cellCount), other(cellCount);
  for (uint32_t n = 0; n < 6 * cellCount; ++n) {
    const uint32_t a = static_cast<uint32_t>(random() % cellCount);
    const uint32_t b = std::min(a + 1 + static_cast<uint32_t>(random() % 30), siteCount - 1);
    if (a == b || alpha[a].count(b) || other[a].count(b)) continue;
    const bool isAlpha = a < chunk.liveCount && random() % 3 == 0;
    for (const auto& [cell, neighbour] : {std::pair{a, b}, std::pair{b, a}}) {
      if (cell < cellCount) (isAlpha && cell < chunk.liveCount ? alpha : other)[cell].insert(neighbour);
    }
  }
  chunk.neighbourOffsets.push_back(0);
  for (uint32_t cell = 0; cell < cellCount; ++cell) {
    chunk.neighbours.insert(chunk.neighbours.end(), alpha[cell].begin(), alpha[cell].end());
    if (hasWalkGraph) chunk.neighbours.insert(chunk.neighbours.end(), other[cell].begin(), other[cell].end());
    chunk.neighbourOffsets.push_back(static_cast<uint32_t>(chunk.neighbours.size()));
    if (cell < chunk.liveCount) chunk.alphaCounts.push_back(static_cast<uint32_t>(alpha[cell].size()));
  }
  sortGraphRows(chunk, 0, cellCount);
  return chunk;
}

}  // namespace froth
