// What live cells show, in as few bits as their numbers need, to be read by shaders/gpu/cell_bits.glsl.
//
// Numbers of one kind share a step in a chunk and a width in a cell. Heights and base colours of a cell lie
// close together: the cell holds the lowest, its detail sites what they add to it. A cell starts at a byte;
// lowest bits first:
//
//   density         code.densityBits, above code.densityLowest
//   orientation     1 + 2 * code.normalBits: whether the normal is nearer to -x, then its indices
//                   (orientationOfNormal, format/quantization.h); or 4 floats (w, x, y, z)
//   colour scale    code.scaleBits
//   widths          8 of code.widthBits: place, height, base green, base chroma, number of lobes, axis, lobe
//                   green, lobe chroma
//   lowest height   code.heightBits, two's complement
//   lowest base     3 * code.baseBits, two's complement: green, red - green, blue - green
//   own axes        code.ownAxisBits: how many; then 3 * code.axisBits each, two's complement
//   lobe counts     [K]
//   detail sites    [K] place (u, v), height, base colour
//   lobes           [sum of counts] axis, colour
//
// An axis is a label if the chunk has a table of axes: of the table's entries, or behind them of the cell's own
// axes; else it is its components. The table stands before the first cell. Places, written-out axes and colours
// of lobes are two's complement. Kinds of step 0 hold floats of 32 bits; colours are then red, green, blue.
// Shaders get the floats of the reader bit for bit, but for orientations of normals, which they compute again,
// to 1e-6.
#pragma once

#include <cstdint>
#include <vector>

#include "base/result.h"
#include "format/asset_contents.h"
#include "format/chunk_codes.h"
#include "shaders/gpu/layout.h"

namespace froth {

struct PackedCells {
  gpu::CellCode code{};
  std::vector<uint32_t> starts;  // [liveCount] [bytes] into words
  std::vector<uint32_t> words;
  bool hasShortLobes = false;  // the codes of all axes and colours of lobes have 16 bits at most
};

// `asset`: without its chunks. Fails if the bits of one chunk are beyond 32-bit addresses.
Result<PackedCells> packCells(const ChunkContents& chunk, ChunkCodes codes, const AssetContents& asset);

}  // namespace froth
