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
};

// Any two cells of the asset are neighbours; every other pair of them belongs to the alpha-complex.
AssetContents makeSampleAsset(const SampleOptions& options = {});

}  // namespace froth
