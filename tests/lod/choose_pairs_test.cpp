// Which cells become one.
#include "baker/lod/choose_pairs.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <set>

#include "tests/reference/scenes.h"

namespace froth {
namespace {

const glm::vec3 kRed{1, 0, 0}, kBlue{0, 0, 1};

TEST(ChoosePairs, PairsAreDisjointUnlockedLiveAndOverlapping) {
  const Foam foam = randomFoam(400, 2, 2, 3);
  std::vector<uint8_t> isLocked(foam.cellCount, 0);
  for (uint32_t cell = 0; cell < foam.cellCount; cell += 3) isLocked[cell] = 1;
  const std::vector<CellPair> pairs = choosePairs(foam, isLocked, {}, foam.cellCount);
  EXPECT_GT(pairs.size(), 60u);
  std::set<uint32_t> used;
  for (const CellPair& pair : pairs) {
    for (const uint32_t cell : {pair.first, pair.second}) {
      EXPECT_TRUE(used.insert(cell).second) << cell;
      EXPECT_EQ(isLocked[cell], 0) << cell;
      EXPECT_GT(foam.densities[cell], 0) << cell;
    }
    EXPECT_LT(glm::distance(foam.sites[pair.first], foam.sites[pair.second]),
              foam.radii[pair.first] + foam.radii[pair.second]);
  }
}

TEST(ChoosePairs, CellsOfOneColourComeFirst) {
  // A row of overlapping balls: red, blue, blue, red, red.
  const std::vector<glm::vec3> colours{kRed, kBlue, kBlue, kRed, kRed};
  std::vector<PlainCell> row;
  for (const glm::vec3& colour : colours) row.push_back({.site = {float(row.size()), 0, 0}, .colour = colour});
  const std::vector<uint8_t> isLocked(5, 0);
  const std::vector<CellPair> pairs = choosePairs(foamOf(row), isLocked, {}, 5);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].first, 1u);
  EXPECT_EQ(pairs[0].second, 2u);
  EXPECT_EQ(pairs[1].first, 3u);
  EXPECT_EQ(pairs[1].second, 4u);
}

TEST(ChoosePairs, WhatContributesLeastComesFirst) {
  std::vector<PlainCell> row;
  for (int i = 0; i < 4; ++i) row.push_back({.site = {1.5f * float(i) + (i >= 2 ? 5.0f : 0.0f), 0, 0}});
  const std::vector<uint8_t> isLocked(4, 0);
  const std::vector<double> contributions{9, 8, 2, 3};
  const std::vector<CellPair> pairs = choosePairs(foamOf(row), isLocked, contributions, 1);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].first, 2u);
  EXPECT_EQ(pairs[0].second, 3u);
}

TEST(ChoosePairs, TheSameOnAnyNumberOfThreads) {
  const Foam foam = randomFoam(2000, 1, 1, 4);
  const std::vector<uint8_t> isLocked(foam.cellCount, 0);
  const std::vector<CellPair> onAll = choosePairs(foam, isLocked, {}, 900);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const std::vector<CellPair> onOne = choosePairs(foam, isLocked, {}, 900);
  ASSERT_EQ(onOne.size(), onAll.size());
  for (size_t i = 0; i < onAll.size(); ++i) {
    EXPECT_EQ(onOne[i].first, onAll[i].first);
    EXPECT_EQ(onOne[i].second, onAll[i].second);
  }
}

TEST(ChoosePairs, AFoamWithoutFreeCellsHasNoPairs) {
  const std::vector<uint8_t> isLocked(50, 1);
  EXPECT_TRUE(choosePairs(randomFoam(50, 1, 1, 1), isLocked, {}, 50).empty());
}

}  // namespace
}  // namespace froth
