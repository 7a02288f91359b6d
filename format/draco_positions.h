// Positions as kd-trees of Draco. Encoder and decoder stand in the writing and the reading library.
//
//   | run | run | ... | zeros |
//   run: | count, uint32 | size, uint32 | least, 3 x int32 | kd-tree of `count` points, `size` bytes |
//
// A kd-tree is what Draco's DynamicIntegerPointsKdTreeEncoder<6> (bitstream 2.2, 3 dimensions) makes of the
// run's points less `least`. This is the core of Draco's point clouds, without their container, whose decoder
// trusts too much of what it reads.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "format/section_codec.h"

namespace froth {

inline constexpr int kDracoLevel = 6;                // the densest of Draco's variants of the tree
inline constexpr uint16_t kDracoBitstream = 0x0202;  // 2.2

// `raw` is 12 bytes per point. Any bytes are safe: sizes and counts are checked before Draco sees them, and
// what it then does is bounded: memory by stored.size(), time by the number of points.
Status readDracoPositions(std::span<const uint8_t> stored, std::span<uint8_t> raw, const std::string& place);

// An error if the box of a run spans more than kMaxPositionBits along an axis, or the order of a run is not
// Draco's.
Result<std::vector<uint8_t>> writeDracoPositions(std::span<const LatticePoint> points, std::span<const uint32_t> runs);

}  // namespace froth
