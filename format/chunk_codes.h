// The lattice indices of a chunk's numbers, of which the reader makes the floats of ChunkContents.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "format/asset_contents.h"

namespace froth {

// In steps of Quantization; of detail sites, heights and colours times 2^scale of the cell. |index| <= kMaxLatticeIndex
// (format/lattice.h). Empty: there are no such numbers, or they are floats of no lattice.
struct ChunkCodes {
  std::vector<std::array<uint32_t, 2>> normals;  // [liveCount] normalIndices
  std::vector<int32_t> detailSites;              // [2 * liveCount * K]
  std::vector<int32_t> detailHeights;            // [liveCount * K]
  std::vector<int32_t> baseColours;              // [3 * liveCount * K] red, green, blue
  std::vector<int32_t> lobeAxes;                 // [3 * lobes] in steps of axisStep
  std::vector<int32_t> lobeColours;              // [3 * lobes] red, green, blue
  float axisStep = 0;  // Quantization::lobeAxisStep, or that of the codebook's entries where they lie closer
};

struct CodedChunk {
  ChunkContents contents;
  ChunkCodes codes;
};

}  // namespace froth
