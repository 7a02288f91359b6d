// The order of the detail sites of a cell is free; sorted ones take fewer bytes. Internal to baker/bake.
#pragma once

#include <cstdint>

#include "format/asset_contents.h"

namespace froth {

// Sorts the detail sites of each cell by (u, v), with all that belongs to them.
void sortDetails(uint32_t detailCount, ChunkContents& chunk);

}  // namespace froth
