// Exact comparison of assets, for tests.
#pragma once

#include <cstring>

#include <gtest/gtest.h>

#include "format/asset_contents.h"
#include "format/section.h"

namespace froth {

template <class Element>
bool haveSameBits(const std::vector<Element>& a, const std::vector<Element>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Element)) == 0);
}

inline bool operator==(const StoredCamera& a, const StoredCamera& b) {
  return a.worldFromCamera == b.worldFromCamera && a.tanHalfFovY == b.tanHalfFovY;
}

inline void expectSameParameters(const AssetContents& a, const AssetContents& b) {
  EXPECT_EQ(a.detailCount, b.detailCount);
  EXPECT_EQ(a.lobeCount, b.lobeCount);
  EXPECT_EQ(a.localBits, b.localBits);
  EXPECT_EQ(a.hasWalkGraph, b.hasWalkGraph);
  EXPECT_EQ(a.detailSharpness, b.detailSharpness);
  EXPECT_EQ(a.nearRatio, b.nearRatio);
  EXPECT_EQ(a.nearDepth, b.nearDepth);
  EXPECT_EQ(a.preset, b.preset);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(std::memcmp(&a.statistics, &b.statistics, sizeof(BakeStatistics)), 0);
  EXPECT_EQ(a.hasStartView, b.hasStartView);
  EXPECT_TRUE(a.startView == b.startView);
  EXPECT_TRUE(a.flightPath == b.flightPath);
}

inline void expectSameArrays(const ChunkContents& a, const ChunkContents& b) {
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.cellCount, b.cellCount);
  EXPECT_EQ(a.liveCount, b.liveCount);
  EXPECT_TRUE(haveSameBits(a.sites, b.sites));
  EXPECT_TRUE(haveSameBits(a.radii, b.radii));
  EXPECT_TRUE(haveSameBits(a.neighbourOffsets, b.neighbourOffsets));
  EXPECT_TRUE(haveSameBits(a.neighbours, b.neighbours));
  EXPECT_TRUE(haveSameBits(a.alphaCounts, b.alphaCounts));
  EXPECT_TRUE(haveSameBits(a.densities, b.densities));
  EXPECT_TRUE(haveSameBits(a.orientations, b.orientations));
  EXPECT_TRUE(haveSameBits(a.detailSites, b.detailSites));
  EXPECT_TRUE(haveSameBits(a.detailHeights, b.detailHeights));
  EXPECT_TRUE(haveSameBits(a.lobeAxes, b.lobeAxes));
  EXPECT_TRUE(haveSameBits(a.lobeColours, b.lobeColours));
}

inline void expectSameAsset(const AssetContents& a, const AssetContents& b) {
  expectSameParameters(a, b);
  ASSERT_EQ(a.chunks.size(), b.chunks.size());
  for (size_t i = 0; i < a.chunks.size(); ++i) {
    SCOPED_TRACE("chunk " + std::to_string(i));
    expectSameArrays(a.chunks[i], b.chunks[i]);
  }
}

}  // namespace froth
