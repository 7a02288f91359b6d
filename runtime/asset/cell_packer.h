// What live cells show, in as few bits as their numbers need, to be read by shaders/gpu/cell_bits.glsl.
//
// Numbers of one kind share a step in a chunk and a width in a cell. Heights and base colours of a cell lie
// close together: the cell holds the lowest, its detail sites what they add to it. A cell starts at a byte;
// lowest bits first:
//
//   density           code.densityBits, above code.densityLowest
//   orientation       a bit and 2 x code.normalBits: orientationOfNormal (format/quantization.h), the bit
//   tells that its normal
//                     is nearer to -x; or 4 floats (w, x, y, z). The one thing that shaders compute again, to
//                     1e-6
//   colour scale      code.scaleBits
//   widths            code.widthBits each: place, height, base green, base chroma, lobes, axis, lobe green,
//   lobe chroma lowest height     code.heightBits, two's complement lowest base       code.baseBits each,
//   two's complement: green, red - green, blue - green own axes          code.ownAxisBits: how many; then 3 x
//   code.axisBits each, two's complement numbers of lobes  [K] detail sites      [K]
//   place (u, v), height, base colour lobes             [sum] axis, colour. The axis is a label if the chunk
//   has a table of axes: of its entries, or
//                     behind them of the cell's own axes; else its components
//
// Places, written-out axes and colours of lobes are two's complement. Kinds of step 0 hold floats of 32 bits;
// colours are then red, green, blue. The table of axes stands before the first cell.
#pragma once

#include <cstdint>
#include <vector>

#include "format/asset_contents.h"
#include "format/result.h"
#include "shaders/gpu/layout.h"

namespace froth {

struct PackedCells {
  gpu::CellCode code{};
  std::vector<uint32_t> starts;  // [liveCount] [bytes] into words
  std::vector<uint32_t> words;
};

// normalBits: of the asset's quantization. Fails if the bits of one chunk are beyond 32-bit addresses.
Result<PackedCells> packCells(const ChunkContents& chunk, uint32_t detailCount, uint32_t lobeCount,
                              uint32_t normalBits);

}  // namespace froth
