// The order in which a chunk's cells lie decides which codec its positions can have: Draco's kd-tree gives
// points back in an order of its own. The baker asks here before it puts a chunk's cells into their order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"
#include "format/section_codec.h"

namespace froth {

// Decoding a point costs this much more by Draco than by Morton-delta; measured by froth_bench_codecs.
inline constexpr double kDracoDecodeCost = 4;
// A codec is worth its smaller size up to this factor in decode cost.
inline constexpr double kMaxDecodeCost = 8;

// order[i] is the index in `points` of the point that lies i-th: either their own order (0, 1, 2 ...; they
// should lie in Morton order) or, if positions get smaller by it at a decode cost within kMaxDecodeCost,
// Draco's. Ask for the live cells and for the other cells of a chunk separately (each is a run of
// encodePositions); Draco only if both answers have it.
struct PositionOrder {
  bool isDraco = false;
  std::vector<uint32_t> order;
};
Result<PositionOrder> choosePositionOrder(std::span<const LatticePoint> points);

// Draco's order of the points; equal points keep theirs. An error if their box spans more than
// kMaxPositionBits.
Result<std::vector<uint32_t>> dracoOrder(std::span<const LatticePoint> points);

}  // namespace froth
