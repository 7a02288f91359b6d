// Exact comparison of assets, for tests.
#pragma once

#include <cstring>

#include <gtest/gtest.h>

#include "format/asset_contents.h"
#include "tests/same_bits.h"

namespace froth {

inline bool operator==(const StoredCamera& a, const StoredCamera& b) {
  return a.worldFromCamera == b.worldFromCamera && a.tanHalfFovY == b.tanHalfFovY;
}

inline bool operator==(const AttributeError& a, const AttributeError& b) {
  return a.name == b.name && a.unit == b.unit && a.rms == b.rms && a.max == b.max;
}

inline void expectSameEyes(const EyeRegion& a, const EyeRegion& b) {
  ASSERT_EQ(a.boxes.size(), b.boxes.size());
  for (size_t i = 0; i < a.boxes.size(); ++i) {
    EXPECT_EQ(a.boxes[i].min, b.boxes[i].min);
    EXPECT_EQ(a.boxes[i].max, b.boxes[i].max);
  }
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.worstPsnr, b.worstPsnr);
  EXPECT_EQ(a.meanPsnr, b.meanPsnr);
}

inline void expectSameQuantization(const Quantization& a, const Quantization& b) {
  EXPECT_EQ(a.positionStep, b.positionStep);
  EXPECT_EQ(a.radiusBits, b.radiusBits);
  EXPECT_EQ(a.densityBits, b.densityBits);
  EXPECT_EQ(a.normalBits, b.normalBits);
  EXPECT_EQ(a.detailSiteStep, b.detailSiteStep);
  EXPECT_EQ(a.heightStep, b.heightStep);
  EXPECT_EQ(a.colourStep, b.colourStep);
  EXPECT_EQ(a.lobeAxisStep, b.lobeAxisStep);
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
  expectSameQuantization(a.quantization, b.quantization);
  EXPECT_TRUE(haveSameBits(a.axisCodebook, b.axisCodebook));
  EXPECT_TRUE(a.errors == b.errors);
  EXPECT_EQ(a.psnr, b.psnr);
  EXPECT_EQ(a.hasStartView, b.hasStartView);
  EXPECT_TRUE(a.startView == b.startView);
  EXPECT_TRUE(a.flightPath == b.flightPath);
  expectSameEyes(a.eyes, b.eyes);
}

inline void expectSameArrays(const ChunkContents& a, const ChunkContents& b) {
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.cellCount, b.cellCount);
  EXPECT_EQ(a.liveCount, b.liveCount);
  EXPECT_EQ(a.ghostCount, b.ghostCount);
  EXPECT_TRUE(haveSameBits(a.sites, b.sites));
  EXPECT_TRUE(haveSameBits(a.radii, b.radii));
  EXPECT_TRUE(haveSameBits(a.ghostRefs, b.ghostRefs));
  EXPECT_TRUE(haveSameBits(a.borderCells, b.borderCells));
  EXPECT_TRUE(haveSameBits(a.borderNumbers, b.borderNumbers));
  EXPECT_TRUE(haveSameBits(a.neighbourOffsets, b.neighbourOffsets));
  EXPECT_TRUE(haveSameBits(a.neighbours, b.neighbours));
  EXPECT_TRUE(haveSameBits(a.alphaCounts, b.alphaCounts));
  EXPECT_TRUE(haveSameBits(a.densities, b.densities));
  EXPECT_TRUE(haveSameBits(a.orientations, b.orientations));
  EXPECT_TRUE(haveSameBits(a.cellColours, b.cellColours));
  EXPECT_TRUE(haveSameBits(a.cellHeights, b.cellHeights));
  EXPECT_TRUE(haveSameBits(a.solidBalls, b.solidBalls));
  EXPECT_TRUE(haveSameBits(a.detailSites, b.detailSites));
  EXPECT_TRUE(haveSameBits(a.detailHeights, b.detailHeights));
  EXPECT_TRUE(haveSameBits(a.baseColours, b.baseColours));
  EXPECT_TRUE(haveSameBits(a.detailScales, b.detailScales));
  EXPECT_TRUE(haveSameBits(a.colourScales, b.colourScales));
  EXPECT_TRUE(haveSameBits(a.lobeCounts, b.lobeCounts));
  EXPECT_TRUE(haveSameBits(a.lobeAxes, b.lobeAxes));
  EXPECT_TRUE(haveSameBits(a.lobeColours, b.lobeColours));
}

inline void expectSameLevels(const AssetContents& a, const AssetContents& b) {
  EXPECT_EQ(a.borderCount, b.borderCount);
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (size_t i = 0; i < a.levels.size(); ++i) {
    EXPECT_EQ(a.levels[i].level, b.levels[i].level) << "chunk " << i;
    EXPECT_EQ(a.levels[i].madeBy, b.levels[i].madeBy) << "chunk " << i;
    EXPECT_EQ(a.levels[i].in, b.levels[i].in) << "chunk " << i;
  }
  ASSERT_EQ(a.groups.size(), b.groups.size());
  for (size_t i = 0; i < a.groups.size(); ++i) {
    EXPECT_EQ(a.groups[i].centre, b.groups[i].centre) << "group " << i;
    EXPECT_EQ(a.groups[i].radius, b.groups[i].radius) << "group " << i;
    EXPECT_EQ(a.groups[i].error, b.groups[i].error) << "group " << i;
    EXPECT_EQ(a.groups[i].level, b.groups[i].level) << "group " << i;
  }
}

inline void expectSameAsset(const AssetContents& a, const AssetContents& b) {
  expectSameParameters(a, b);
  expectSameLevels(a, b);
  ASSERT_EQ(a.chunks.size(), b.chunks.size());
  for (size_t i = 0; i < a.chunks.size(); ++i) {
    SCOPED_TRACE("chunk " + std::to_string(i));
    expectSameArrays(a.chunks[i], b.chunks[i]);
  }
}

}  // namespace froth
