// The limits of walks where the caller leaves them open: of views, rays and queries alike.
#pragma once

#include <cstdint>

namespace froth {

// 0 becomes the default.
inline void resolveWalkLimits(uint32_t& maxSteps, uint32_t& maxNeighbours) {
  if (maxSteps == 0) maxSteps = 65536;
  if (maxNeighbours == 0) maxNeighbours = 1u << 20;
}

}  // namespace froth
