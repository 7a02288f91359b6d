// How views and chunks share a budget.
#include "runtime/context/level_budget.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace froth::test {
namespace {

constexpr double kUsedPart = 0.7;  // of blocks: what is not used is part of the budget, too

LevelNeeds needsOf(uint64_t chunkBytesPerCell, uint64_t viewBytesPerCell) {
  constexpr uint64_t kFloorCells = 1000, kCells = 50'000;
  return {.floorBytes = kFloorCells * chunkBytesPerCell,
          .changeBytes = kFloorCells * chunkBytesPerCell,
          .finestBytes = kCells * chunkBytesPerCell,
          .allBytes = 3 * kCells * chunkBytesPerCell,
          .floorViewBytes = kFloorCells * viewBytesPerCell,
          .finestViewBytes = kCells * viewBytesPerCell,
          .reservedViewBytes = kCells * viewBytesPerCell};
}

TEST(LevelBudget, SharesNoMoreThanThereIs) {
  std::mt19937 random(1);
  const auto pick = [&](uint32_t most) { return std::uniform_int_distribution<uint32_t>(0, most)(random); };
  for (int i = 0; i < 100'000; ++i) {
    const LevelNeeds needs = needsOf(pick(1000), pick(3000));
    const uint64_t bytes = uint64_t{pick(1000)} * pick(1'000'000);
    const LevelShares shares = shareBudget(bytes, needs);
    const uint64_t views = std::min(shares.viewBytes, needs.reservedViewBytes);
    ASSERT_LE(static_cast<double>(shares.chunkBytes) / kUsedPart + static_cast<double>(views),
              static_cast<double>(bytes) + 1);
  }
}

TEST(LevelBudget, LetsBothReachEquallyFar) {
  const LevelNeeds needs = needsOf(200, 700);
  const LevelShares shares = shareBudget(20'000'000, needs);
  const double chunks = (static_cast<double>(shares.chunkBytes) * 7 / 8 - 400'000) / 200;
  const double views = static_cast<double>(shares.viewBytes) / 700;
  EXPECT_NEAR(chunks, views, 0.1 * views);
}

TEST(LevelBudget, GivesChunksWhatViewsHaveNoUseForAndTheOtherWayRound) {
  const LevelNeeds needs = needsOf(200, 700);
  const LevelShares all = shareBudget(1'000'000'000, needs);
  EXPECT_EQ(all.viewBytes, UINT64_MAX);
  EXPECT_NEAR(static_cast<double>(all.chunkBytes), (1e9 - 35e6) * kUsedPart, 1e6);
  LevelNeeds few = needs;  // whose views have room for few cells, whatever the asset has
  few.reservedViewBytes = 700'000;
  EXPECT_NEAR(static_cast<double>(shareBudget(20'000'000, few).chunkBytes), 19.3e6 * kUsedPart, 1e5);
  LevelNeeds dear = needsOf(1, 10'000);  // whose chunks are all there
  const LevelShares views = shareBudget(300'000'000, dear);
  EXPECT_GE(views.viewBytes, 299'000'000u);
}

TEST(LevelBudget, KeepsRoomForFloorsFirst) {
  const LevelNeeds needs = needsOf(200, 700);
  const LevelShares shares = shareBudget(700'000, needs);
  EXPECT_GE(shares.chunkBytes + 1, needs.floorBytes + needs.changeBytes);  // it is rounded
  EXPECT_EQ(shareBudget(0, needs).chunkBytes, 0u);
}

}  // namespace
}  // namespace froth::test
