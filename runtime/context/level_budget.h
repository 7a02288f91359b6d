// How views and chunks of assets with levels of detail share what the budget leaves beside all else.
#pragma once

#include <cstdint>

namespace froth {

// [bytes] Of all such assets together. Functions of assets, views and instances alone, so the shares are, too.
struct LevelNeeds {
  uint64_t floorBytes = 0;         // chunks of the floors
  uint64_t changeBytes = 0;        // the most that one group holds besides while it changes its form
  uint64_t finestBytes = 0;        // chunks of level 0
  uint64_t allBytes = 0;           // chunks of all levels
  uint64_t floorViewBytes = 0;     // of views, for the cells of the floors
  uint64_t finestViewBytes = 0;    // for those of level 0
  uint64_t reservedViewBytes = 0;  // for as many of those as views make room for ahead (FrothViewInfo::reserveCells)

  LevelNeeds& operator+=(const LevelNeeds& other);
};

struct LevelShares {
  uint64_t chunkBytes = UINT64_MAX;  // of chunks, without what their blocks of memory leave unused
  uint64_t viewBytes = UINT64_MAX;   // for cells of cuts
};

// [bytes] With so much no share is short.
uint64_t bytesForAll(const LevelNeeds& needs);

// Floors first; the rest so that both reach equally far towards level 0. What one has no use for the other gets.
LevelShares shareBudget(uint64_t bytes, const LevelNeeds& needs);

}  // namespace froth
