// A small asset with levels of detail, made by brute force: each level is triangulated as a whole, and merges that
// change a pair of neighbours across groups are undone. So each of its cuts is a power diagram (docs/STREAMING.md).
// Links froth_baker, for the triangulation.
#pragma once

#include <cstdint>

#include "format/asset_contents.h"

namespace froth {

struct LevelSampleOptions {
  uint32_t cellCount = 800;  // of level 0, but for hidden cells
  uint32_t seed = 1;
};

// Three levels of random balls in the cube -1..1, every seventh of them without density. Level 0 has four groups of two
// chunks each, level 1 two groups whose border crosses those of level 0; level 2 is the floor, a chunk for each group
// that made it: 18 chunks. Origins differ; sites lie on a lattice. K = 2, M = 1, cell colours.
AssetContents makeLevelSample(const LevelSampleOptions& options = {});

}  // namespace froth
