// Parts of a foam.
#pragma once

#include <cstdint>
#include <span>

#include "foam/foam.h"

namespace froth {

// What a part keeps; everything in the order that is given.
struct FoamPick {
  std::span<const uint32_t> cells;    // may name a cell again
  std::span<const uint64_t> details;  // [cells * detailCount] cell * K + k; may name a detail site again
  uint32_t detailCount = 0;           // per cell, >= 1
  uint32_t mostLobes = 0;             // of a detail site: its first ones; <= the foam's
};

Foam pickFoam(const Foam& foam, const FoamPick& pick);

}  // namespace froth
