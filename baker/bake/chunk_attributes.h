// Fills the attributes of a chunk's live cells. Internal to baker/bake.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/bake/attribute_errors.h"
#include "baker/bake/cells.h"
#include "foam/foam.h"
#include "format/asset_contents.h"
#include "format/quantization.h"

namespace froth {

// Densities, orientations, detail sites and heights, cell heights; on the chunk's detail scales, if it has any. `live`
// lists the chunk's live cells in order.
void fillFaces(const Foam& foam, const BakeCells& cells, std::span<const uint32_t> live, const Quantization& lattices,
               ChunkContents& chunk, AttributeErrors& errors);

// Colours as they are: cell, base and lobe colours, axes. `sources` lists the live cells in the input foam. Without
// lobes (keepsLobes false) a detail site's colour is that of its first lobe.
void fillColours(const Foam& foam, std::span<const uint32_t> sources, bool keepsLobes, ChunkContents& chunk);

// Whether some detail site looks different from different sides.
bool isViewDependent(const Foam& foam);

}  // namespace froth
