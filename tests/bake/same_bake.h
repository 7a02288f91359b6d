// That two bakes are the same.
#pragma once

#include <gtest/gtest.h>

#include "baker/bake/bake.h"

namespace froth {

inline void expectSameChunk(const ChunkContents& a, const ChunkContents& b) {
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.liveCount, b.liveCount);
  EXPECT_EQ(a.sites, b.sites);
  EXPECT_EQ(a.radii, b.radii);
  EXPECT_EQ(a.ghostRefs, b.ghostRefs);
  EXPECT_EQ(a.borderCells, b.borderCells);
  EXPECT_EQ(a.borderNumbers, b.borderNumbers);
  EXPECT_EQ(a.neighbourOffsets, b.neighbourOffsets);
  EXPECT_EQ(a.neighbours, b.neighbours);
  EXPECT_EQ(a.alphaCounts, b.alphaCounts);
  EXPECT_EQ(a.densities, b.densities);
  EXPECT_EQ(a.orientations, b.orientations);
  EXPECT_EQ(a.cellColours, b.cellColours);
  EXPECT_EQ(a.cellHeights, b.cellHeights);
  EXPECT_EQ(a.solidBalls, b.solidBalls);
  EXPECT_EQ(a.detailSites, b.detailSites);
  EXPECT_EQ(a.detailHeights, b.detailHeights);
  EXPECT_EQ(a.baseColours, b.baseColours);
  EXPECT_EQ(a.detailScales, b.detailScales);
  EXPECT_EQ(a.colourScales, b.colourScales);
  EXPECT_EQ(a.lobeCounts, b.lobeCounts);
  EXPECT_EQ(a.lobeAxes, b.lobeAxes);
  EXPECT_EQ(a.lobeColours, b.lobeColours);
}

inline void expectSameBake(const BakeResult& a, const BakeResult& b) {
  EXPECT_EQ(a.sourceCells, b.sourceCells);
  EXPECT_EQ(a.contents.axisCodebook, b.contents.axisCodebook);
  EXPECT_EQ(a.contents.psnr, b.contents.psnr);
  ASSERT_EQ(a.contents.errors.size(), b.contents.errors.size());
  for (size_t k = 0; k < a.contents.errors.size(); ++k) EXPECT_EQ(a.contents.errors[k].rms, b.contents.errors[k].rms);
  ASSERT_EQ(a.contents.chunks.size(), b.contents.chunks.size());
  for (size_t k = 0; k < a.contents.chunks.size(); ++k) expectSameChunk(a.contents.chunks[k], b.contents.chunks[k]);
}

}  // namespace froth
