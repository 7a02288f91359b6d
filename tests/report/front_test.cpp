#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "measure/report/report.h"

namespace froth {
namespace {

using testing::ElementsAre;

ReportPoint point(const std::string& id, double psnr, Interval time, uint64_t bytes = 1000) {
  ReportPoint made;
  made.id = id;
  made.renderer = "raster";
  made.errors.psnr = psnr;
  made.total = time;
  made.diskBytes = bytes;
  return made;
}

std::vector<std::string> overTime(const std::vector<ReportPoint>& points) {
  return paretoFront(points, "raster", Cost::kTime);
}

TEST(Front, IntervalsThatOverlapAreATie) {
  const Interval low{1.0, 0.9, 1.1}, touching{1.2, 1.1, 1.3}, high{1.5, 1.4, 1.6};
  EXPECT_TRUE(isTie(low, low));
  EXPECT_TRUE(isTie(low, touching));
  EXPECT_TRUE(isTie(touching, low));
  EXPECT_FALSE(isTie(low, high));
  EXPECT_FALSE(isTie(high, low));
}

TEST(Front, HoldsWhatNoOtherBeatsFromCheapToDear) {
  EXPECT_THAT(overTime({point("best", 50, {3, 2.9, 3.1}), point("cheap", 30, {1, 0.9, 1.1}),
                        point("beaten", 29, {2, 1.9, 2.1}), point("middle", 40, {2, 1.9, 2.1})}),
              ElementsAre("cheap", "middle", "best"));
}

TEST(Front, OfTiesInTimeTheOneWithLessErrorStays) {
  EXPECT_THAT(overTime({point("a", 40, {1.0, 0.9, 1.1}), point("b", 41, {1.05, 0.95, 1.15})}), ElementsAre("b"));
}

// b ties with both a and c, but a and c are apart: what c beats must not take a away with it.
//   a |---|
//   b    |----|
//   c       |---|
TEST(Front, ATieWithATieIsNoTie) {
  EXPECT_THAT(
      overTime({point("a", 40, {1.0, 0.9, 1.1}), point("b", 41, {1.15, 1.05, 1.25}), point("c", 42, {1.3, 1.2, 1.4})}),
      ElementsAre("a", "c"));
}

TEST(Front, AHundredthOfADecibelIsNotLessError) {
  EXPECT_THAT(overTime({point("cheap", 40.000, {1, 0.99, 1.01}), point("dear", 40.004, {2, 1.99, 2.01})}),
              ElementsAre("cheap"));
  EXPECT_THAT(overTime({point("cheap", 40.00, {1, 0.99, 1.01}), point("dear", 40.02, {2, 1.99, 2.01})}),
              ElementsAre("cheap", "dear"));
}

TEST(Front, BytesHaveNoNoise) {
  EXPECT_THAT(paretoFront({point("a", 40, {5, 1, 9}, 1000), point("b", 41, {5, 1, 9}, 1001),
                           point("as large as a", 39, {1, 1, 1}, 1000)},
                          "raster", Cost::kDiskBytes),
              ElementsAre("a", "b"));
}

TEST(Front, PointsOfOtherRenderersOrWithoutFiguresAreNotOnIt) {
  std::vector<ReportPoint> points{point("equal", std::numeric_limits<double>::infinity(), {2, 2, 2}),
                                  point("broken", std::nan(""), {1, 1, 1}), point("unmeasured", 60, {})};
  points.push_back(point("walk", 70, {0.1, 0.1, 0.1}));
  points.back().renderer = "walk";
  EXPECT_THAT(overTime(points), ElementsAre("equal"));
  EXPECT_THAT(paretoFront(points, "cpu", Cost::kTime), ElementsAre());
}

TEST(RoundOrder, IsAnotherInEachRoundAndTheSameForASeed) {
  std::vector<std::string> groups;
  for (int i = 0; i < 40; ++i) groups.push_back(std::to_string(i % 10));
  const std::vector<size_t> first = orderOfRound(groups, 1, 0);
  EXPECT_EQ(orderOfRound(groups, 1, 0), first);
  EXPECT_NE(orderOfRound(groups, 1, 1), first);
  EXPECT_NE(orderOfRound(groups, 2, 0), first);
}

TEST(RoundOrder, NamesEachOnceAndKeepsAGroupTogether) {
  const std::vector<std::string> groups{"a", "b", "a", "c", "b", "a"};
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<size_t> order = orderOfRound(groups, seed, 2);
    std::set<size_t> seen(order.begin(), order.end());
    EXPECT_EQ(seen.size(), groups.size());
    size_t changes = 0;
    for (size_t k = 1; k < order.size(); ++k) changes += groups[order[k]] != groups[order[k - 1]];
    EXPECT_EQ(changes, 2u) << seed;
  }
}

}  // namespace
}  // namespace froth
