// The ball that a ray enters first, by asking all of them.
#pragma once

#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/query/query_foam.h"
#include "shaders/foam/cell.h"

namespace froth::test {

inline std::vector<uint32_t> allChunks(size_t count) {
  std::vector<uint32_t> chunks(count);
  std::iota(chunks.begin(), chunks.end(), 0u);
  return chunks;
}

// Returns whether there is one.
inline bool expectFirstBall(const QueryFoam& foam, std::span<const uint32_t> chunks, const glm::dvec3& origin,
                            const glm::dvec3& direction, double from) {
  double first = HUGE_VAL;
  for (const uint32_t number : chunks) {
    const QueryChunk& chunk = foam.chunk(number);
    for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) {
      double tNear, tFar;
      const glm::dvec3 centre = chunk.siteOf(cell) - (origin - chunk.origin);
      if (!foam::intersectBall(centre, chunk.radiusOf(cell), direction, tNear, tFar) || tFar <= from) continue;
      first = std::min(first, std::max(tNear, from));
    }
  }
  EXPECT_EQ(foam.findFirstBall(origin, direction, from, HUGE_VAL).t, first);
  return first < HUGE_VAL;
}

}  // namespace froth::test
