// The steps of a bake that fill a chunk's arrays. Internal to baker/bake.
#pragma once

#include <cstdint>
#include <span>

#include "baker/foam.h"
#include "baker/graph/graph.h"
#include "format/asset_contents.h"

namespace froth {

// Fills neighbourOffsets, neighbours and alphaCounts. `order` lists the source cell of every place in the
// chunk, live cells first; `chunk` already holds cellCount and liveCount. Every neighbour of a listed cell
// must be listed.
void fillGraphRows(const Foam& foam, const CellGraph& walkGraph, const CellGraph& alphaGraph,
                   std::span<const uint32_t> order, ChunkContents& chunk);

// Fills sites and radii of all cells, and the other attributes of the live ones.
void fillAttributes(const Foam& foam, std::span<const uint32_t> order, ChunkContents& chunk);

}  // namespace froth
