#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baker/graph/graph.h"
#include "tests/graph/power_oracle.h"

namespace froth {
namespace {

RegularTriangulation triangulate(const BallSet& balls) {
  Result<RegularTriangulation> result = triangulateRegular(balls.sites, balls.radii);
  EXPECT_TRUE(result) << result.error().message;
  return std::move(*result);
}

std::vector<uint32_t> rowOf(const CellGraph& graph, uint32_t cell) {
  return {graph.neighbours.begin() + graph.offsets[cell], graph.neighbours.begin() + graph.offsets[cell + 1]};
}

TEST(RegularTriangulation, HoldsEveryPairWhosePowerCellsShareAFace) {
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    for (const BallSet& balls : makeBallSets(seed)) {
      const RegularTriangulation triangulation = triangulate(balls);
      const std::vector<FacePoint> faces = sampleFaces(balls, 600, seed);
      ASSERT_TRUE(balls.size() == 1 || !faces.empty()) << balls.name;
      for (const FacePoint& face : faces) {
        ASSERT_TRUE(hasPair(triangulation.graph, face.a, face.b))
            << balls.name << ", seed " << seed << ": pair " << face.a << ", " << face.b;
      }
    }
  }
}

TEST(RegularTriangulation, IsSymmetricAndSortedWithoutLoops) {
  for (const BallSet& balls : makeBallSets(7)) {
    const CellGraph graph = triangulate(balls).graph;
    ASSERT_EQ(graph.offsets.size(), balls.size() + 1u);
    for (uint32_t i = 0; i < balls.size(); ++i) {
      const std::vector<uint32_t> row = rowOf(graph, i);
      EXPECT_TRUE(std::adjacent_find(row.begin(), row.end(), std::greater_equal<>()) == row.end()) << balls.name;
      for (const uint32_t j : row) EXPECT_TRUE(j != i && hasPair(graph, j, i)) << balls.name;
    }
  }
}

// The walk of point location: always to the neighbour of least power, while that lowers the power.
TEST(RegularTriangulation, DescendingThePowerFromAnyVisibleCellFindsThePowerCell) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    for (const BallSet& balls : makeBallSets(seed)) {
      const RegularTriangulation triangulation = triangulate(balls);
      BallSetMaker random(seed);
      for (uint32_t start = 0; start < balls.size(); ++start) {
        if (triangulation.isHidden[start]) continue;
        const uint32_t near = static_cast<uint32_t>(random.uniform(0, balls.size()));
        const glm::dvec3 x = glm::dvec3(balls.sites[near]) + random.pointInCube(-1, 1) * double{balls.radii[near]};
        uint32_t cell = start;
        for (bool isMoving = true; isMoving;) {
          uint32_t best = cell;
          for (const uint32_t j : rowOf(triangulation.graph, cell)) {
            if (powerAt(balls, j, x) < powerAt(balls, best, x)) best = j;
          }
          isMoving = best != cell;
          cell = best;
        }
        ASSERT_NEAR(powerAt(balls, cell, x), powerAt(balls, findPowerCell(balls, x), x), 1e-9)
            << balls.name << ", seed " << seed;
      }
    }
  }
}

TEST(RegularTriangulation, HidesExactlyTheCellsWithoutAPowerCell) {
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    BallSetMaker make(seed);
    for (const BallSet& balls : {make.stiff(24), make.foamLike(24)}) {
      const RegularTriangulation triangulation = triangulate(balls);
      for (uint32_t i = 0; i < balls.size(); ++i) {
        const bool surelyExists = NearestPointOracle(balls, i, -1e-9).distanceToCell() < INFINITY;
        const bool mayExist = NearestPointOracle(balls, i, 1e-9).distanceToCell() < INFINITY;
        ASSERT_FALSE(surelyExists && triangulation.isHidden[i]) << balls.name << ", seed " << seed << ", cell " << i;
        ASSERT_FALSE(!mayExist && !triangulation.isHidden[i]) << balls.name << ", seed " << seed << ", cell " << i;
        EXPECT_TRUE(!triangulation.isHidden[i] || rowOf(triangulation.graph, i).empty());
      }
    }
  }
}

//   O   O      a small ball amid eight large ones whose spheres reach beyond the middle
//     .
//   O   O
TEST(RegularTriangulation, HidesASmallBallCoveredByLargeOnes) {
  BallSet balls{"cube", {{0, 0, 0}}, {0.1f}};
  for (int corner = 0; corner < 8; ++corner) {
    balls.add({corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1}, 2.0f);
  }
  const RegularTriangulation triangulation = triangulate(balls);
  EXPECT_EQ(triangulation.isHidden[0], 1);
  EXPECT_EQ(std::count(triangulation.isHidden.begin(), triangulation.isHidden.end(), 1), 1);
  EXPECT_TRUE(rowOf(triangulation.graph, 0).empty());
  EXPECT_EQ(triangulation.duplicates, 0u);
}

TEST(RegularTriangulation, KeepsTheLargestThenTheFirstOfCoincidingSites) {
  const BallSet balls{"coinciding", {{0, 0, 0}, {5, 0, 0}, {0.0f, -0.0f, 0}, {5, 0, 0}, {0, 0, 0}}, {1, 2, 3, 2, 3}};
  const RegularTriangulation triangulation = triangulate(balls);
  EXPECT_EQ(triangulation.duplicates, 3u);
  EXPECT_THAT(triangulation.isHidden, testing::ElementsAre(1, 0, 0, 1, 1));
  EXPECT_THAT(rowOf(triangulation.graph, 2), testing::ElementsAre(1));
}

//   0---1---2---3   only neighbours on the line share a face
TEST(RegularTriangulation, OfALineIsTheChain) {
  const BallSet balls{"line", {{1, 1, 1}, {2, 2, 2}, {4, 4, 4}, {7, 7, 7}}, {1, 1, 1, 1}};
  const CellGraph graph = triangulate(balls).graph;
  EXPECT_THAT(rowOf(graph, 0), testing::ElementsAre(1));
  EXPECT_THAT(rowOf(graph, 1), testing::ElementsAre(0, 2));
  EXPECT_THAT(rowOf(graph, 2), testing::ElementsAre(1, 3));
}

// Scaling by a power of two keeps every digit, so the graph must stay; the predicates' terms reach the fifth
// power.
TEST(RegularTriangulation, IsTheSameAtAnyScale) {
  const BallSet balls = BallSetMaker(3).foamLike(60);
  const CellGraph reference = triangulate(balls).graph;
  for (const int exponent : {-60, 60}) {
    BallSet scaled = balls;
    for (glm::vec3& site : scaled.sites) site *= std::ldexp(1.0f, exponent);
    for (float& radius : scaled.radii) radius *= std::ldexp(1.0f, exponent);
    EXPECT_EQ(triangulate(scaled).graph.neighbours, reference.neighbours) << exponent;
  }
}

TEST(RegularTriangulation, OfNoSitesIsEmpty) {
  const RegularTriangulation triangulation = triangulate({"none", {}, {}});
  EXPECT_THAT(triangulation.graph.offsets, testing::ElementsAre(0));
}

TEST(RegularTriangulation, RefusesNumbersThatAreNotFiniteAndNamesTheCell) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const std::vector<glm::vec3> good = {{0, 0, 0}, {1, 0, 0}};
  const std::vector<glm::vec3> badSite = {{0, 0, 0}, {1, nan, 0}};
  const std::vector<float> radii = {1, 1};
  Result<RegularTriangulation> result = triangulateRegular(badSite, radii);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kBadInput);
  EXPECT_THAT(result.error().message, testing::HasSubstr("cell 1"));
  for (const float radius : {nan, infinity, 0.0f, -1.0f}) {
    const std::vector<float> badRadii = {1, radius};
    EXPECT_FALSE(triangulateRegular(good, badRadii)) << radius;
  }
}

TEST(RegularTriangulation, StopsWhenAskedTo) {
  BallSetMaker make(1);
  const BallSet balls = make.foamLike(1000);
  const Progress stopHalfway = [](std::string_view, uint64_t done, uint64_t total) { return done < total / 2; };
  const Result<RegularTriangulation> result = triangulateRegular(balls.sites, balls.radii, stopHalfway);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace froth
