// What must hold for contents to be an asset: asked by the reader after, and by the writer before, the bytes.
#pragma once

#include <cfloat>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include "base/result.h"
#include "format/asset_contents.h"
#include "format/section.h"

namespace froth {

// Ranges of everything but the chunks. `file` names the asset in messages.
Status checkParameters(const AssetContents& asset, const std::string& file);
Status checkCodebookSize(const AssetContents& asset, uint64_t size, const std::string& file);

// Number of chunks; counts, origin and bounds of each; levels and groups. `asset` has passed checkParameters; its
// chunks are not looked at.
Status checkChunkIndices(const AssetContents& asset, std::span<const ChunkIndex> chunks, const std::string& file);
Status checkChunkIndex(const AssetContents& asset, const ChunkIndex& chunk, const std::string& place);

// Array lengths (the chunk's counts decide; optional arrays may be empty), numbers within limits.h, positive radii,
// ascending ghosts, rows that hold what they may. `asset` has passed checkParameters. `place` names the chunk
// in messages.
Status checkChunk(const AssetContents& asset, const ChunkContents& chunk, const std::string& place);

// Ghosts live in another chunk, in a cell that exists; with levels, their borders and the chunk's own exist. It is
// enough to give the highest reference into each chunk, and the highest border.
Status checkReferences(const AssetContents& asset, std::span<const ChunkIndex> chunks, uint32_t index,
                       std::span<const CellRef> ghosts, std::span<const uint32_t> borders, const std::string& place);

// Normalised in float, a quaternion's length carries some 4 roundings of half of FLT_EPSILON and each component one or
// two of its own, so |q|^2 is off by at most about 2 * (4 + 2) of them; twice that is allowed. A longer one would scale
// its frame, beyond the floats at last.
inline bool isUnitQuaternion(const glm::vec4& orientation) {
  constexpr double kTolerance = 12 * FLT_EPSILON;
  const glm::dvec4 q(orientation);
  return std::abs(glm::dot(q, q) - 1) <= kTolerance;  // false for NaN
}

// Box of the balls of live cells, relative to the chunk's origin.
Box liveBoundsOf(const ChunkContents& chunk);

// A reference taken apart. Correct for localBits 32 too, where a 32-bit shift would be undefined.
inline uint32_t chunkOf(CellRef cell, uint32_t localBits) { return static_cast<uint32_t>(uint64_t{cell} >> localBits); }
inline uint32_t localOf(CellRef cell, uint32_t localBits) {
  return static_cast<uint32_t>(cell & ((uint64_t{1} << localBits) - 1));
}

}  // namespace froth
