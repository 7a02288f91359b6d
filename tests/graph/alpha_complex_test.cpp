#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "foam/cech_pairs.h"
#include "shaders/foam/cell.h"
#include "tests/graph/graphs.h"
#include "tests/graph/power_oracle.h"

namespace froth {
namespace {

TEST(AlphaComplex, HoldsEveryFaceThatIsMetInsideTheBalls) {
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    for (const BallSet& balls : makeBallSets(seed)) {
      const Graphs graphs = makeGraphs(balls);
      for (const FacePoint& face : sampleFaces(balls, 600, seed + 100)) {
        if (face.power >= 0) continue;
        ASSERT_TRUE(hasPair(graphs.alpha.graph, face.a, face.b))
            << balls.name << ", seed " << seed << ": pair " << face.a << ", " << face.b;
      }
    }
  }
}

// A part of a scene: some cells, then all their neighbours.
TEST(AlphaComplex, OfCellsWithAllTheirNeighboursIsThatOfTheWhole) {
  for (const BallSet& balls : {BallSetMaker(3).foamLike(600), BallSetMaker(4).stiff(400)}) {
    const Graphs whole = makeGraphs(balls);
    std::vector<uint32_t> cells, placeOf(balls.size(), UINT32_MAX);
    const auto add = [&](uint32_t cell) {
      if (placeOf[cell] != UINT32_MAX) return;
      placeOf[cell] = static_cast<uint32_t>(cells.size());
      cells.push_back(cell);
    };
    for (uint32_t cell = 0; cell < balls.size(); ++cell) {
      if (balls.sites[cell].x < 5 && !whole.triangulation.isHidden[cell]) add(cell);
    }
    const auto complete = static_cast<uint32_t>(cells.size());
    for (uint32_t k = 0; k < complete; ++k) {
      for (const uint32_t neighbour : neighboursOf(whole.triangulation.graph, cells[k])) add(neighbour);
    }
    ASSERT_LT(complete, cells.size());
    BallSet part;
    for (const uint32_t cell : cells) part.add(balls.sites[cell], balls.radii[cell]);
    const Result<RegularTriangulation> triangulation = triangulateRegular(part.sites, part.radii);
    ASSERT_TRUE(triangulation);
    const AlphaComplex alpha = computeAlphaComplex(part.sites, part.radii, *triangulation, {}, complete);
    for (uint32_t k = 0; k < complete; ++k) {
      EXPECT_EQ(alpha.isEmpty[k], whole.alpha.isEmpty[cells[k]]);
      std::vector<uint32_t> row;
      for (const uint32_t neighbour : neighboursOf(alpha.graph, k)) row.push_back(cells[neighbour]);
      std::ranges::sort(row);
      // a neighbour in the ring may be empty in the whole, where it has no pairs
      std::erase_if(row, [&](uint32_t cell) { return whole.alpha.isEmpty[cell] != 0; });
      EXPECT_TRUE(std::ranges::equal(row, neighboursOf(whole.alpha.graph, cells[k]))) << balls.name << " " << cells[k];
    }
  }
}

TEST(AlphaComplex, HoldsAPairExactlyIfItsFaceComesIntoTheBall) {
  uint32_t inside = 0, outside = 0;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    BallSetMaker make(seed);
    for (const BallSet& balls : {make.foamLike(20), make.foamLike(20, 1000), make.stiff(20)}) {
      const Graphs graphs = makeGraphs(balls);
      for (uint32_t i = 0; i < balls.size(); ++i) {
        const NearestPointOracle narrowed(balls, i, -1e-8), widened(balls, i, 1e-8);
        for (uint32_t j = 0; j < balls.size(); ++j) {
          if (i == j) continue;
          const bool surelyTrue = narrowed.distanceToFace(j) < balls.radii[i] * (1 - 1e-8);
          const bool surelyFalse = widened.distanceToFace(j) > balls.radii[i] * (1 + 1e-8);
          const bool isKept = hasPair(graphs.alpha.graph, i, j);
          ASSERT_FALSE(surelyTrue && !isKept) << balls.name << ", seed " << seed << ": " << i << ", " << j;
          ASSERT_FALSE(surelyFalse && isKept) << balls.name << ", seed " << seed << ": " << i << ", " << j;
          inside += surelyTrue;
          outside += surelyFalse;
        }
      }
    }
  }
  EXPECT_GT(inside, 1000u);
  EXPECT_GT(outside, 1000u);
}

TEST(AlphaComplex, MarksExactlyTheCellsWhoseBallLiesInOtherPowerCells) {
  uint32_t emptyCells = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    BallSetMaker make(seed);
    for (const BallSet& balls : {make.stiff(24), make.foamLike(24)}) {
      const Graphs graphs = makeGraphs(balls);
      for (uint32_t i = 0; i < balls.size(); ++i) {
        if (graphs.triangulation.isHidden[i]) continue;
        const bool surelyVisible = NearestPointOracle(balls, i, -1e-8).distanceToCell() < balls.radii[i] * (1 - 1e-8);
        const bool surelyEmpty = NearestPointOracle(balls, i, 1e-8).distanceToCell() > balls.radii[i] * (1 + 1e-8);
        ASSERT_FALSE(surelyVisible && graphs.alpha.isEmpty[i]) << balls.name << ", seed " << seed << ", cell " << i;
        ASSERT_FALSE(surelyEmpty && !graphs.alpha.isEmpty[i]) << balls.name << ", seed " << seed << ", cell " << i;
        emptyCells += surelyEmpty;
      }
    }
  }
  EXPECT_GT(emptyCells, 20u);
}

struct Interval {
  double near = 0, far = 0;
  double length() const { return std::max(far - near, 0.0); }
};

// What a ray leaves of a ball after the planes towards the listed cells.
template <class Cells>
Interval clipRay(const BallSet& balls, uint32_t cell, const Cells& others, const glm::dvec3& origin,
                 const glm::dvec3& direction) {
  const glm::dvec3 centre = glm::dvec3(balls.sites[cell]) - origin;
  const double radius = balls.radii[cell];
  Interval interval;
  if (!foam::intersectBall(centre, radius, direction, interval.near, interval.far)) return {};
  for (const uint32_t other : others) {
    const glm::dvec3 toOther = glm::dvec3(balls.sites[other]) - glm::dvec3(balls.sites[cell]);
    if (other == cell || toOther == glm::dvec3(0)) continue;
    const double offset = foam::radicalOffset(toOther, radius, double{balls.radii[other]});
    foam::clipByPlane(foam::radicalClearance(centre, toOther, offset), glm::dot(toOther, direction),
                      foam::comesFirst(toOther), interval.near, interval.far);
  }
  return interval;
}

TEST(AlphaComplex, ItsPlanesLeaveTheSameBoundedCellsAsAllPlanes) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    for (const BallSet& balls : makeBallSets(seed)) {
      const Graphs graphs = makeGraphs(balls);
      const CellGraph& alpha = graphs.alpha.graph;
      BallSetMaker random(seed);
      std::vector<uint32_t> all(balls.size());
      for (uint32_t i = 0; i < balls.size(); ++i) all[i] = i;
      for (uint32_t i = 0; i < balls.size(); ++i) {
        const std::vector<uint32_t> row(alpha.neighbours.begin() + alpha.offsets[i],
                                        alpha.neighbours.begin() + alpha.offsets[i + 1]);
        const bool isVisible = !graphs.triangulation.isHidden[i] && !graphs.alpha.isEmpty[i];
        const double radius = balls.radii[i];
        for (int ray = 0; ray < 40; ++ray) {
          const glm::dvec3 through = glm::dvec3(balls.sites[i]) + random.pointInCube(-0.6, 0.6) * radius;
          const glm::dvec3 direction = glm::normalize(random.pointInCube(-1, 1) + glm::dvec3(1e-3));
          const glm::dvec3 origin = through - 3 * radius * direction;
          const Interval expected = clipRay(balls, i, all, origin, direction);
          const bool isDuplicate = graphs.triangulation.isHidden[i] && graphs.triangulation.duplicates > 0;
          ASSERT_TRUE(isVisible || isDuplicate || expected.length() <= 1e-8 * radius)
              << balls.name << ", seed " << seed << ", cell " << i;
          if (!isVisible) continue;
          const Interval found = clipRay(balls, i, row, origin, direction);
          ASSERT_NEAR(found.length(), expected.length(), 1e-8 * radius)
              << balls.name << ", seed " << seed << ", cell " << i;
          ASSERT_TRUE(expected.length() == 0 || std::abs(found.near - expected.near) <= 1e-8 * radius) << balls.name;
        }
      }
    }
  }
}

//  (0)(1)(2)   the middle ball separates the outer two, though these overlap
TEST(AlphaComplex, DropsAPairOfOverlappingBallsThatAThirdSeparates) {
  const BallSet balls{"row", {{0, 0, 0}, {1, 0, 0}, {2, 0.1f, 0}}, {1.1f, 2.0f, 1.1f}};
  const Graphs graphs = makeGraphs(balls);
  EXPECT_TRUE(hasPair(graphs.alpha.graph, 0, 1) && hasPair(graphs.alpha.graph, 1, 2));
  EXPECT_FALSE(hasPair(graphs.alpha.graph, 0, 2));
  EXPECT_EQ(findCechPairs(balls.sites, balls.radii).neighbours.size(), 6u);
}

TEST(AlphaComplex, OfAGridIsTheGrid) {
  BallSetMaker make(1);
  const uint32_t side = 5;
  const BallSet balls = make.grid(side, 0.7f);  // diagonal faces degenerate to edges, sqrt(1/2) from the sites
  EXPECT_EQ(makeGraphs(balls).alpha.graph.neighbours.size(), 6 * side * side * (side - 1));
}

//  ( 0 )  (1)   balls that touch nothing are whole, and not empty
TEST(AlphaComplex, LeavesLonelyBallsWhole) {
  const Graphs graphs = makeGraphs({"lonely", {{0, 0, 0}, {5, 0, 0}}, {1, 2}});
  EXPECT_TRUE(hasPair(graphs.triangulation.graph, 0, 1));
  EXPECT_TRUE(graphs.alpha.graph.neighbours.empty());
  EXPECT_EQ(graphs.alpha.isEmpty, std::vector<uint8_t>({0, 0}));
}

//  a small ball just inside the skin of a large one: its radical plane lies beyond it, so it has a power cell
//  but no bounded cell; of the plane's half-space it sees nothing
TEST(AlphaComplex, MarksABallInsideAnotherAsEmpty) {
  const Graphs graphs = makeGraphs({"swallowed", {{0, 0, 0}, {0.8f, 0, 0}}, {1, 0.1f}});
  EXPECT_EQ(graphs.triangulation.isHidden, std::vector<uint8_t>({0, 0}));
  EXPECT_EQ(graphs.alpha.isEmpty, std::vector<uint8_t>({0, 1}));
  EXPECT_TRUE(graphs.alpha.graph.neighbours.empty());
}

// One ball with 20,000 small ones on its skin: decided from the small ones' side, in linear time.
TEST(AlphaComplex, CopesWithACellOfManyNeighbours) {
  BallSetMaker random(1);
  BallSet balls{"hub", {{0, 0, 0}}, {1}};
  for (int i = 0; i < 20000; ++i) {
    balls.add(glm::vec3(glm::normalize(random.pointInCube(-1, 1) + glm::dvec3(1e-3))), 0.002f);
  }
  const Graphs graphs = makeGraphs(balls);
  EXPECT_EQ(graphs.triangulation.graph.offsets[1], 20000u);
  EXPECT_EQ(graphs.alpha.graph.offsets[1], 20000u);
  EXPECT_EQ(std::count(graphs.alpha.isEmpty.begin(), graphs.alpha.isEmpty.end(), 1), 0);
}

TEST(AlphaComplex, IsTheSameOnAnyNumberOfThreads) {
  BallSetMaker make(5);
  const BallSet balls = make.foamLike(5000);
  const Graphs many = makeGraphs(balls);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Graphs single = makeGraphs(balls);
  EXPECT_EQ(many.alpha.graph.offsets, single.alpha.graph.offsets);
  EXPECT_EQ(many.alpha.graph.neighbours, single.alpha.graph.neighbours);
  EXPECT_EQ(many.alpha.isEmpty, single.alpha.isEmpty);
}

}  // namespace
}  // namespace froth
