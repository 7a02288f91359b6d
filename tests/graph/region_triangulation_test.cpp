#include <algorithm>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "baker/graph/graph.h"
#include "tests/graph/ball_sets.h"

namespace froth {
namespace {

Progress recordStages(std::set<std::string>& stages) {
  return [&](std::string_view stage, uint64_t, uint64_t) {
    stages.emplace(stage);
    return true;
  };
}

void expectWhole(const BallSet& balls, const Result<RegularTriangulation>& regions) {
  const Result<RegularTriangulation> whole = triangulateRegular(balls.sites, balls.radii);
  ASSERT_TRUE(whole);
  ASSERT_TRUE(regions) << balls.name << ": " << regions.error().message;
  EXPECT_EQ(regions->duplicates, whole->duplicates) << balls.name;
  EXPECT_TRUE(regions->isHidden == whole->isHidden) << balls.name;
  EXPECT_TRUE(regions->graph.offsets == whole->graph.offsets) << balls.name;
  EXPECT_TRUE(regions->graph.neighbours == whole->graph.neighbours) << balls.name;
}

// The same graph as in one piece; returns the names of the stages that were reported.
std::set<std::string> expectSameAsTheWhole(const BallSet& balls, const RegionPlan& plan) {
  SCOPED_TRACE(plan.ownCells);
  std::set<std::string> stages;
  expectWhole(balls, triangulateRegions(balls.sites, balls.radii, plan, recordStages(stages)));
  return stages;
}

const auto kNotInOnePiece = testing::Not(testing::Contains("triangulate"));

// A grid has eight cospherical sites around each corner, and whole sides of coplanar ones: only CGAL's
// symbolic perturbation decides its edges.
TEST(RegionTriangulation, OfDegenerateSitesIsThatOfTheWhole) {
  BallSetMaker make(3);
  BallSet shaken = make.grid(10, 0.8f), mixed = make.grid(10, 0.8f);
  for (glm::vec3& site : shaken.sites) site += glm::vec3(make.pointInCube(-1e-6, 1e-6));
  for (size_t i = 0; i < mixed.sites.size(); i += 3) mixed.sites.push_back(mixed.sites[i]);
  mixed.radii.resize(mixed.sites.size(), 0.8f);
  for (const BallSet& balls : {make.grid(10, 0.8f), shaken, mixed}) {
    for (const uint32_t regionCells : {20u, 128u, 600u}) {
      EXPECT_THAT(expectSameAsTheWhole(balls, {regionCells}), kNotInOnePiece);
    }
  }
}

TEST(RegionTriangulation, OfFoamsIsThatOfTheWhole) {
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    BallSetMaker make(seed);
    for (const BallSet& balls : {make.foamLike(3000), make.foamLike(3000, 1e6), make.stiff(3000),
                                 make.withDuplicates(3000), make.withNearDuplicates(3000)}) {
      for (const uint32_t regionCells : {100u, 1000u}) {
        EXPECT_THAT(expectSameAsTheWhole(balls, {regionCells}), kNotInOnePiece);
      }
    }
  }
}

TEST(RegionTriangulation, OfSmallSetsIsThatOfTheWholeWhateverTheRegions) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    for (const BallSet& balls : makeBallSets(seed)) {
      for (const uint32_t regionCells : {1u, 7u, 40u}) expectSameAsTheWhole(balls, {regionCells});
    }
  }
}

// Sites in a plane have no regions of their own dimension.
TEST(RegionTriangulation, OfSitesInAPlaneIsDoneInOnePiece) {
  EXPECT_THAT(expectSameAsTheWhole(BallSetMaker(1).coplanar(500), {50}), testing::Contains("triangulate"));
}

// A plane of sites with one above it: every region lies in the plane.
TEST(RegionTriangulation, OfAPlaneAndOneSiteAboveItIsThatOfTheWhole) {
  BallSet balls = BallSetMaker(1).coplanar(500);
  balls.add({5, 5, 9}, 1);
  EXPECT_THAT(expectSameAsTheWhole(balls, {50}), kNotInOnePiece);
}

// All cells meet all but in one point.
TEST(RegionTriangulation, OfSitesOnASphereIsThatOfTheWhole) {
  BallSetMaker make(1);
  BallSet balls{"sphere", {}, {}};
  for (int i = 0; i < 1500; ++i) balls.add(glm::vec3(glm::normalize(make.pointInCube(-1, 1))), 0.1f);
  expectSameAsTheWhole(balls, {100});
}

TEST(RegionTriangulation, OfRegionsThatGrowTooLargeIsDoneInHalves) {
  const BallSet balls = BallSetMaker(2).foamLike(3000);
  EXPECT_THAT(expectSameAsTheWhole(balls, {1500, 1600}), kNotInOnePiece);
}

TEST(RegionTriangulation, IsRefusedWhereNoRegionIsSmallEnough) {
  BallSetMaker make(1);
  BallSet balls{"hub", {}, {}};
  for (int i = 0; i < 1500; ++i) balls.add(glm::vec3(glm::normalize(make.pointInCube(-1, 1))), 0.1f);
  balls.add({0, 0, 0}, 0.5f);
  const Result<RegularTriangulation> result = triangulateRegions(balls.sites, balls.radii, {100, 300});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kUnsupported);
  EXPECT_THAT(result.error().message, testing::HasSubstr("raise the limit"));
}

TEST(RegionTriangulation, IsChosenByTheMemoryLimit) {
  const BallSet balls = BallSetMaker(5).foamLike(10000);
  const auto within = [&](uint64_t limit, std::set<std::string>& stages) {
    return triangulateWithin(limit, balls.sites, balls.radii, recordStages(stages));
  };
  std::set<std::string> unlimited, large, small, none;
  expectWhole(balls, within(0, unlimited));
  EXPECT_THAT(unlimited, testing::Contains("triangulate"));
  expectWhole(balls, within(1 << 30, large));
  EXPECT_THAT(large, testing::Contains("triangulate"));
  expectWhole(balls, within(6 << 20, small));
  EXPECT_THAT(small, kNotInOnePiece);
  const Result<RegularTriangulation> refused = within(1 << 20, none);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("memory limit of 1.0 MB"));
}

TEST(RegionTriangulation, IsTheSameOnAnyNumberOfThreads) {
  const BallSet balls = BallSetMaker(4).foamLike(5000);
  expectSameAsTheWhole(balls, {300});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  expectSameAsTheWhole(balls, {300});
}

TEST(RegionTriangulation, StopsWhenAskedTo) {
  const BallSet balls = BallSetMaker(1).foamLike(3000);
  const Progress stopHalfway = [](std::string_view stage, uint64_t done, uint64_t total) {
    return stage != "triangulate regions" || done < total / 2;
  };
  const Result<RegularTriangulation> result = triangulateRegions(balls.sites, balls.radii, {200}, stopHalfway);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kCancelled);
}

TEST(RegionTriangulation, RefusesNumbersThatAreNotFinite) {
  BallSet balls = BallSetMaker(1).foamLike(100);
  balls.radii[70] = std::numeric_limits<float>::quiet_NaN();
  const Result<RegularTriangulation> result = triangulateRegions(balls.sites, balls.radii, {20});
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, testing::HasSubstr("cell 70"));
}

}  // namespace
}  // namespace froth
