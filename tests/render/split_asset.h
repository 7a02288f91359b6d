// A one-chunk asset, with M lobes at every detail site, taken apart into chunks with ghosts.
#pragma once

#include <cstdint>

#include "format/asset_contents.h"

namespace froth::test {

// `count` chunks of neighbouring cells, by splits at the median. Origins lie on multiples of `grid` [scene units], near
// their chunk; 0: all at the world's origin. Where sites lie on the grid too, no chunk rounds a site.
AssetContents splitAsset(const AssetContents& whole, uint32_t count, double grid);

}  // namespace froth::test
