// What a decoded chunk tells of itself and of others, as far as it costs little to see that it lies. `froth verify`
// checks all of it (format/read/asset_verify.cpp).
#pragma once

#include <string>

#include "base/result.h"
#include "format/asset_contents.h"

namespace froth {

// That the bounds hold the balls of live cells, and that no cell lies where a neighbour does: no plane parts them.
// Place: for messages.
Status checkClaims(const ChunkContents& chunk, const Box& liveBounds, const std::string& place);

}  // namespace froth
