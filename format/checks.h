// What must hold for contents to be an asset: asked by the reader after, and by the writer before, the bytes.
#pragma once

#include <cstdint>
#include <string>

#include "format/asset_contents.h"
#include "format/result.h"

namespace froth {

// Counts, ranges and finite numbers of everything but the chunks' arrays. `file` names the asset in messages.
Status checkParameters(const AssetContents& asset, const std::string& file);

// Array lengths (chunk.cellCount and liveCount decide), finite numbers, positive radii, monotone offsets,
// references to cells that exist. `asset` has passed checkParameters.
Status checkChunk(const AssetContents& asset, uint32_t index, const ChunkContents& chunk,
                  const std::string& file);

// Box of the balls of live cells, relative to the chunk's origin.
Box liveBoundsOf(const ChunkContents& chunk);

// A reference taken apart. Correct for localBits 32 too, where a 32-bit shift would be undefined.
inline uint32_t chunkOf(CellRef cell, uint32_t localBits) {
  return static_cast<uint32_t>(uint64_t{cell} >> localBits);
}
inline uint32_t localOf(CellRef cell, uint32_t localBits) {
  return static_cast<uint32_t>(cell & ((uint64_t{1} << localBits) - 1));
}

}  // namespace froth
