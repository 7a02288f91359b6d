#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baker/graph/graph.h"
#include "foam/cech_pairs.h"
#include "foam/morton_order.h"
#include "tests/graph/power_oracle.h"

namespace froth {
namespace {

bool overlap(const BallSet& balls, uint32_t a, uint32_t b) {
  const glm::dvec3 difference = glm::dvec3(balls.sites[a]) - glm::dvec3(balls.sites[b]);
  const double reach = double{balls.radii[a]} + balls.radii[b];
  return glm::dot(difference, difference) < reach * reach;
}

TEST(CechPairs, AreExactlyThePairsOfOverlappingBalls) {
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    std::vector<BallSet> sets = makeBallSets(seed);
    sets.push_back(BallSetMaker(seed).foamLike(150, 1e7));
    sets.push_back(BallSetMaker(seed).grid(5, 0.5f));  // touching balls do not overlap
    for (const BallSet& balls : sets) {
      const CellGraph graph = findCechPairs(balls.sites, balls.radii);
      ASSERT_EQ(graph.offsets.size(), balls.size() + 1u);
      for (uint32_t i = 0; i < balls.size(); ++i) {
        std::vector<uint32_t> expected;
        for (uint32_t j = 0; j < balls.size(); ++j) {
          if (i != j && overlap(balls, i, j)) expected.push_back(j);
        }
        ASSERT_EQ(std::vector<uint32_t>(graph.neighbours.begin() + graph.offsets[i],
                                        graph.neighbours.begin() + graph.offsets[i + 1]),
                  expected)
            << balls.name << ", seed " << seed << ", cell " << i;
      }
    }
  }
}

TEST(CechPairs, HoldTheAlphaComplex) {
  for (const BallSet& balls : makeBallSets(9)) {
    const Result<RegularTriangulation> triangulation = triangulateRegular(balls.sites, balls.radii);
    ASSERT_TRUE(triangulation);
    const CellGraph alpha = computeAlphaComplex(balls.sites, balls.radii, *triangulation).graph;
    const CellGraph cech = findCechPairs(balls.sites, balls.radii);
    for (uint32_t i = 0; i < balls.size(); ++i) {
      for (uint32_t entry = alpha.offsets[i]; entry < alpha.offsets[i + 1]; ++entry) {
        EXPECT_TRUE(hasPair(cech, i, alpha.neighbours[entry])) << balls.name;
      }
    }
  }
}

TEST(CechPairs, AreNotFoundWhenAskedToStop) {
  const BallSet balls = BallSetMaker(1).foamLike(100);
  const auto stop = [](std::string_view, uint64_t, uint64_t) { return false; };
  EXPECT_TRUE(findCechPairs(balls.sites, balls.radii, stop).offsets.empty());
}

TEST(CechPairs, OfNoBallsAreNone) { EXPECT_THAT(findCechPairs({}, {}).offsets, testing::ElementsAre(0)); }

//  2--3
//   \       the Z of the curve: x changes fastest, then y, then z
//  0--1
TEST(MortonOrder, FollowsTheZCurve) {
  std::vector<glm::vec3> corners;
  for (int k = 7; k >= 0; --k) corners.emplace_back(k & 1, k >> 1 & 1, k >> 2 & 1);
  EXPECT_THAT(mortonOrder(corners), testing::ElementsAre(7, 6, 5, 4, 3, 2, 1, 0));
}

TEST(MortonOrder, BreaksTiesByIndex) {
  const std::vector<glm::vec3> sites = {{1, 1, 1}, {0, 0, 0}, {1, 1, 1}, {0, 0, 0}};
  EXPECT_THAT(mortonOrder(sites), testing::ElementsAre(1, 3, 0, 2));
  EXPECT_THAT(mortonOrder(std::vector<glm::vec3>(3, glm::vec3(2))), testing::ElementsAre(0, 1, 2));
  EXPECT_TRUE(mortonOrder({}).empty());
}

}  // namespace
}  // namespace froth
