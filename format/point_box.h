// The box of lattice points, and their places in it. Internal to the writing half of format/.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "format/section_codec.h"

namespace froth {

struct PointBox {
  LatticePoint least{};
  uint32_t bits = 0;  // that the largest extent needs [0..32]

  std::array<uint32_t, 3> offsetOf(const LatticePoint& point) const {
    std::array<uint32_t, 3> offset;
    for (size_t axis = 0; axis < 3; ++axis) {
      offset[axis] = static_cast<uint32_t>(point[axis]) - static_cast<uint32_t>(least[axis]);
    }
    return offset;
  }
};

inline PointBox boxOf(std::span<const LatticePoint> points) {
  PointBox box;
  if (points.empty()) return box;
  LatticePoint most = box.least = points.front();
  for (const LatticePoint& point : points) {
    for (size_t axis = 0; axis < 3; ++axis) {
      box.least[axis] = std::min(box.least[axis], point[axis]);
      most[axis] = std::max(most[axis], point[axis]);
    }
  }
  for (const uint32_t extent : box.offsetOf(most)) {
    box.bits = std::max(box.bits, static_cast<uint32_t>(std::bit_width(extent)));
  }
  return box;
}

}  // namespace froth
