// The alpha-complex on sets that break careless constructions: no pair may be missing.
#include <algorithm>
#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baker/graph/graph.h"
#include "tests/graph/power_oracle.h"

namespace froth {
namespace {

BallSet named(BallSet balls, const char* name) {
  balls.name = name;
  return balls;
}

std::vector<BallSet> makeDegenerateSets() {
  BallSetMaker make(11);
  BallSet shaken = named(make.grid(6, 0.9f), "grid +- 1e-6");
  for (glm::vec3& site : shaken.sites) site += glm::vec3(make.pointInCube(-1e-6, 1e-6));
  BallSet giants = named(make.foamLike(300), "giant spheres");
  for (int i = 0; i < 4; ++i) giants.add(glm::vec3(make.pointInCube(-900, 910)), 1000);
  BallSet crowded = named(make.foamLike(300), "30 % hidden");
  for (float& radius : crowded.radii) radius *= static_cast<float>(make.uniform(0.3, 2.6));
  BallSet repeated = named(make.grid(6, 0.9f), "grid with duplicates");
  for (uint32_t i = 0; i < 100; ++i) repeated.add(repeated.sites[i], 0.5f + 0.01f * static_cast<float>(i));
  return {make.withDuplicates(300),
          repeated,
          make.coplanar(200),
          make.grid(6, 0.9f),
          shaken,
          named(make.foamLike(300, 1e6), "offset 1e6"),
          giants,
          crowded};
}

// Sample points lie on the faces of the diagram that lines from ball to ball meet, each face found by brute
// force over all balls; some hundred per cell, so that faces down to some percent of a cell's width are met.
TEST(DegenerateSets, LackNoPairOfTheAlphaComplex) {
  for (const BallSet& balls : makeDegenerateSets()) {
    const Result<RegularTriangulation> triangulation = triangulateRegular(balls.sites, balls.radii);
    ASSERT_TRUE(triangulation) << balls.name;
    const AlphaComplex alpha = computeAlphaComplex(balls.sites, balls.radii, *triangulation);
    size_t inside = 0;
    for (const FacePoint& face : sampleFaces(balls, 5000, 17)) {
      if (face.power >= 0) continue;
      ++inside;
      ASSERT_TRUE(hasPair(alpha.graph, face.a, face.b)) << balls.name << ": " << face.a << ", " << face.b;
      ASSERT_TRUE(!alpha.isEmpty[face.a] && !alpha.isEmpty[face.b]) << balls.name;
    }
    EXPECT_GT(inside, 3000u) << balls.name;
    const ValidityReport report = checkGraphs(balls.sites, balls.radii, *triangulation, alpha, 3);
    EXPECT_TRUE(report.faults.empty()) << balls.name << ": " << report.faults.front();
  }
}

// The first ball touches the second from within, where the third has the space: without the plane that cuts it off, its
// other plane would leave most of it. As found by the random search.
TEST(DegenerateSets, ABallThatTouchesAnotherFromWithinIsEmpty) {
  const std::vector<glm::vec3> sites = {
      {17389516, 32757282, -93339768}, {17639516, 32757282, -93339768}, {17139516, 32257284, -93339768}};
  const std::vector<float> radii = {250000, 500000, 500000};
  const Result<RegularTriangulation> triangulation = triangulateRegular(sites, radii);
  ASSERT_TRUE(triangulation);
  const AlphaComplex alpha = computeAlphaComplex(sites, radii, *triangulation);
  EXPECT_THAT(alpha.isEmpty, testing::ElementsAre(1, 0, 0));
  EXPECT_FALSE(hasPair(alpha.graph, 0, 2));
  EXPECT_TRUE(hasPair(alpha.graph, 1, 2));
}

TEST(DegenerateSets, HaveManyHiddenCellsWhereTheyShould) {
  const BallSet balls = makeDegenerateSets().back();
  const Result<RegularTriangulation> triangulation = triangulateRegular(balls.sites, balls.radii);
  EXPECT_GT(std::count(triangulation->isHidden.begin(), triangulation->isHidden.end(), 1),
            static_cast<std::ptrdiff_t>(balls.size() * 3 / 10));
}

// One ball with 80,000 small ones on its skin. A polygon of the hub clipped by all its planes, once for each,
// would be 6.4e9 clips, a minute; from the small ones' side it takes a fraction of a second.
TEST(DegenerateSets, AHubOfEightyThousandNeighboursTakesNoQuadraticTime) {
  constexpr uint32_t kNeighbours = 80000;
  BallSetMaker random(1);
  BallSet balls{"hub", {{0, 0, 0}}, {1}};
  for (uint32_t i = 0; i < kNeighbours; ++i) {
    balls.add(glm::vec3(glm::normalize(random.pointInCube(-1, 1) + glm::dvec3(1e-3))), 0.002f);
  }
  const Result<RegularTriangulation> triangulation = triangulateRegular(balls.sites, balls.radii);
  ASSERT_TRUE(triangulation);
  const auto begin = std::chrono::steady_clock::now();
  const AlphaComplex alpha = computeAlphaComplex(balls.sites, balls.radii, *triangulation);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_EQ(alpha.graph.offsets[1], kNeighbours);
  EXPECT_LT(seconds, 5);
}

}  // namespace
}  // namespace froth
