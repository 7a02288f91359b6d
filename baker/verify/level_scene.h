// A level of an asset as an asset of its own.
#pragma once

#include <cstdint>

#include "format/asset_contents.h"

namespace froth {

// The chunks of one level (format/levels.h), without levels: ghosts name their cells by chunk and index. `contents`
// holds all its chunks, has levels and has passed verifyAsset.
AssetContents sceneOfLevel(const AssetContents& contents, uint32_t level);

}  // namespace froth
