// Fills the attributes of a chunk's live cells. Internal to baker/bake.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/bake/attribute_errors.h"
#include "baker/cells/cells.h"
#include "foam/foam.h"
#include "format/asset_contents.h"
#include "format/quantization.h"

namespace froth {

// `faces` holds the chunk's live cells, in order, as in the input.
//
// Densities, orientations, detail sites and heights, cell heights; on the chunk's detail scales, if it has any. `live`
// lists the same cells in the scene.
void fillFaces(const Foam& faces, const BakeCells& cells, std::span<const uint32_t> live, const Quantization& lattices,
               ChunkContents& chunk, AttributeErrors& errors);

// Colours as they are: cell, base and lobe colours, axes. Without lobes (keepsLobes false) a detail site's colour is
// that of its first lobe.
void fillColours(const Foam& faces, bool keepsLobes, ChunkContents& chunk);

// Whether some detail site looks different from different sides.
bool isViewDependent(const Foam& foam);

}  // namespace froth
