// Small assets made up for tests: random numbers, but with every property that verifyAsset asks for.
#pragma once

#include <cstdint>

#include "format/asset_contents.h"

namespace froth {

struct SampleOptions {
  uint32_t chunkCount = 1;
  uint32_t cellsPerChunk = 6;  // of these, the last third is not live
  uint32_t localBits = 32;
  uint32_t detailCount = 2, lobeCount = 2;
  bool hasHeights = true;
  bool hasWalkGraph = true;
  bool isQuantized = false;   // all attributes, each on a lattice of its own
  bool hasLayers = false;     // cell colours and heights, base colours; lobe counts that differ
  uint32_t codebookSize = 0;  // of lobe axes; some axes lie a few steps beside their entry
};

// Any two cells of the asset are neighbours, so each chunk has the cells of all others as ghosts; every other
// pair of them belongs to the alpha-complex.
AssetContents makeSampleAsset(const SampleOptions& options = {});

}  // namespace froth
