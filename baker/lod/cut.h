// One choice of an asset's levels, as an asset without levels.
#pragma once

#include <cstdint>
#include <span>

#include "base/result.h"
#include "format/asset_contents.h"

namespace froth {

// The chunks that are drawn where the marked groups are refined (docs/STREAMING.md); ghosts name chunk and cell.
// isRefined: [groups]; all 1: level 0, all 0: the floor. Contents without levels stay as they are. kBadInput: a ghost
// stands in no drawn chunk, or stands elsewhere there.
Result<AssetContents> contentsOfCut(const AssetContents& contents, std::span<const uint8_t> isRefined);

}  // namespace froth
