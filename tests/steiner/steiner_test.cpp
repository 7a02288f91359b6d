#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "baker/graph/graph.h"
#include "baker/steiner/crowded_cells.h"
#include "baker/steiner/steiner.h"
#include "baker/steiner/walk_length.h"
#include "tests/graph/ball_sets.h"

namespace froth {
namespace {

constexpr float kOpaque = 1000;

// A cube of side 10 lined with small balls, a thin ball of dust here and there: emptiness to the far wall.
//    oooooooooo
//    o        o
//    o   .    o
//    oooooooooo
BallSet makeRoom(uint32_t side) {
  BallSet balls{"room", {}, {}};
  const float pitch = 10.0f / static_cast<float>(side - 1);
  for (uint32_t k = 0; k < side * side * side; ++k) {
    const glm::uvec3 place(k % side, k / side % side, k / side / side);
    const bool isWall = glm::any(glm::equal(place, glm::uvec3(0))) || glm::any(glm::equal(place, glm::uvec3(side - 1)));
    if (isWall) balls.add(pitch * glm::vec3(place), 0.8f * pitch);
  }
  BallSetMaker maker(5);
  for (int i = 0; i < 20; ++i) balls.add(glm::vec3(maker.pointInCube(1, 9)), 0.1f * pitch);
  return balls;
}

std::vector<BallSet> makeScenes() {
  std::vector<BallSet> scenes = makeBallSets(1);
  scenes.push_back(BallSetMaker(2).foamLike(800, 1e6));
  scenes.push_back(makeRoom(12));
  scenes.push_back({"one ball", {{1, 2, 3}}, {0.5f}});
  BallSet giant = makeRoom(10);
  giant.name = "giant neighbour";
  giant.add({5, 5, -40000}, 39998);
  scenes.push_back(giant);
  BallSet doubled = makeRoom(8);
  doubled.name = "duplicates";
  for (uint32_t i = 0, count = doubled.size(); i < count; i += 3) {
    doubled.add(doubled.sites[i], 0.9f * doubled.radii[i]);
  }
  scenes.push_back(doubled);
  return scenes;
}

Result<SteinerCells> place(const BallSet& balls, const SteinerOptions& options = {}, float density = kOpaque) {
  return placeSteinerCells(balls.sites, balls.radii, std::vector<float>(balls.size(), density), options);
}

BallSet with(BallSet balls, const SteinerCells& cells) {
  balls.sites.insert(balls.sites.end(), cells.sites.begin(), cells.sites.end());
  balls.radii.insert(balls.radii.end(), cells.radii.begin(), cells.radii.end());
  return balls;
}

AlphaComplex alphaOf(const BallSet& balls) {
  return computeAlphaComplex(balls.sites, balls.radii, *triangulateRegular(balls.sites, balls.radii));
}

size_t mostNeighbours(const CellGraph& graph) {
  size_t most = 0;
  for (size_t i = 0; i + 1 < graph.offsets.size(); ++i) {
    most = std::max<size_t>(most, graph.offsets[i + 1] - graph.offsets[i]);
  }
  return most;
}

// One ball in a room of 11,616 wall cells, which is a neighbour of a quarter of them.
TEST(Steiner, ACellThatTouchesThousandsIsSplit) {
  const BallSet room = makeRoom(45);
  BallSet balls = with(room, {{{5, 5, 5}}, {4}, 0, 0});
  CellGraph graph = triangulateRegular(balls.sites, balls.radii)->graph;
  ASSERT_GT(mostNeighbours(graph), 2000u);
  for (uint32_t round = 0; round < 4; ++round) {
    const SteinerCells more = splitCrowdedCells(balls.sites, balls.radii, room.size(), graph, {}, round);
    if (more.sites.empty()) break;
    balls = with(balls, more);
    graph = triangulateRegular(balls.sites, balls.radii)->graph;
  }
  EXPECT_LE(mostNeighbours(graph), 1024u);
  EXPECT_LT(balls.size(), room.size() + 400);
  for (size_t s = room.size() + 1; s < balls.size(); ++s) {
    for (uint32_t i = 0; i < room.size(); ++i) {
      const double distance = glm::distance(glm::dvec3(balls.sites[s]), glm::dvec3(balls.sites[i]));
      ASSERT_GT(distance, double{balls.radii[s]} + balls.radii[i]);
    }
  }
  EXPECT_TRUE(splitCrowdedCells(balls.sites, balls.radii, room.size(), graph, {}, 4).sites.empty());
}

TEST(Steiner, NoBallMeetsABallOfTheScene) {
  size_t placed = 0;
  for (const BallSet& balls : makeScenes()) {
    const Result<SteinerCells> cells = place(balls);
    ASSERT_TRUE(cells) << balls.name;
    placed += cells->sites.size();
    for (size_t s = 0; s < cells->sites.size(); ++s) {
      for (uint32_t i = 0; i < balls.size(); ++i) {
        const double distance = glm::length(glm::dvec3(cells->sites[s]) - glm::dvec3(balls.sites[i]));
        ASSERT_GT(distance, double{cells->radii[s]} + balls.radii[i]) << balls.name << ": " << s << " and " << i;
      }
    }
  }
  EXPECT_GT(placed, 40u);
}

TEST(Steiner, RowsOfTheAlphaComplexAreTheSameWithAndWithoutThem) {
  for (const BallSet& balls : makeScenes()) {
    const Result<SteinerCells> cells = place(balls);
    ASSERT_TRUE(cells) << balls.name;
    const CellGraph without = alphaOf(balls).graph, added = alphaOf(with(balls, *cells)).graph;
    const std::vector<uint32_t> offsets(added.offsets.begin(), added.offsets.begin() + balls.size() + 1);
    ASSERT_EQ(offsets, without.offsets) << balls.name;
    const std::vector<uint32_t> rows(added.neighbours.begin(), added.neighbours.begin() + offsets.back());
    ASSERT_EQ(rows, without.neighbours) << balls.name;
  }
}

// A radius is rounded down, never up: a step of few bits is wider than the gap that the cells leave.
TEST(Steiner, WithRadiiOfFewBitsTouchNothingEither) {
  BallSet sparse = BallSetMaker(3).foamLike(300);
  for (float& radius : sparse.radii) radius *= 0.4f;
  for (const BallSet& balls : {makeRoom(12), sparse}) {
    for (const uint32_t bits : {4u, 5u, 6u}) {
      SteinerOptions options;
      options.radiusBits = bits;
      const Result<SteinerCells> cells = place(balls, options);
      ASSERT_TRUE(cells);
      ASSERT_FALSE(cells->sites.empty());
      for (size_t s = 0; s < cells->sites.size(); ++s) {
        for (uint32_t i = 0; i < balls.size(); ++i) {
          const double distance = glm::length(glm::dvec3(cells->sites[s]) - glm::dvec3(balls.sites[i]));
          ASSERT_GT(distance, double{cells->radii[s]} + balls.radii[i]) << balls.name << ", " << bits << " bits";
        }
      }
      const CellGraph without = alphaOf(balls).graph, added = alphaOf(with(balls, *cells)).graph;
      ASSERT_TRUE(std::equal(without.offsets.begin(), without.offsets.end(), added.offsets.begin())) << bits;
      ASSERT_TRUE(std::equal(without.neighbours.begin(), without.neighbours.end(), added.neighbours.begin())) << bits;
    }
  }
}

TEST(Steiner, CellsAreTheSameOnAnyNumberOfThreads) {
  const BallSet balls = makeRoom(14);
  const Result<SteinerCells> expected = place(balls);
  ASSERT_TRUE(expected);
  for (const size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Result<SteinerCells> cells = place(balls);
    ASSERT_TRUE(cells);
    EXPECT_EQ(cells->sites, expected->sites) << threads;
    EXPECT_EQ(cells->radii, expected->radii) << threads;
  }
}

TEST(Steiner, CellsLieOnTheLattices) {
  BallSet balls = makeRoom(10);
  SteinerOptions options;
  options.positionStep = 0x1p-6;
  options.radiusBits = 7;
  const Result<SteinerCells> cells = place(balls, options);
  ASSERT_TRUE(cells);
  ASSERT_FALSE(cells->sites.empty());
  for (size_t s = 0; s < cells->sites.size(); ++s) {
    for (int axis = 0; axis < 3; ++axis) {
      const double index = cells->sites[s][axis] / options.positionStep;
      ASSERT_EQ(index, std::floor(index));
    }
    ASSERT_EQ(cells->radii[s], floorMantissa(cells->radii[s], options.radiusBits));
  }
}

TEST(Steiner, FullScenesGetNone) {
  const Result<SteinerCells> cells = place(BallSetMaker(1).grid(8, 0.9f));
  ASSERT_TRUE(cells);
  EXPECT_TRUE(cells->sites.empty());
}

TEST(Steiner, WalksInARoomAreAQuarterShorterAndMeetFewerNeighbours) {
  const BallSet balls = makeRoom(24);
  const Result<SteinerCells> cells = place(balls);
  ASSERT_TRUE(cells);
  std::vector<WalkRay> rays;
  BallSetMaker maker(9);
  for (int i = 0; i < 2000; ++i) {
    WalkRay ray;
    ray.origin = maker.pointInCube(2, 8);
    ray.direction = ray.forward = glm::normalize(maker.pointInCube(-1, 1) + glm::dvec3(1e-3));
    rays.push_back(ray);
  }
  const auto measure = [&](const BallSet& scene) {
    std::vector<float> densities(scene.size(), 0);
    std::fill(densities.begin(), densities.begin() + balls.size(), kOpaque);
    const RegularTriangulation triangulation = *triangulateRegular(scene.sites, scene.radii);
    return measureWalkLength({scene.sites, scene.radii, densities, {}}, triangulation.graph, rays);
  };
  const WalkLength without = measure(balls), shorter = measure(with(balls, *cells));
  EXPECT_LT(shorter.meanSteps(), 0.75 * without.meanSteps());
  EXPECT_LT(static_cast<double>(shorter.neighbours), 0.95 * static_cast<double>(without.neighbours));
}

TEST(Steiner, StopsOnRequestAtAnyTime) {
  const BallSet balls = makeRoom(8);
  const std::vector<float> densities(balls.size(), kOpaque);
  uint64_t asked = 0, stopAt = UINT64_MAX;
  const auto progress = [&](std::string_view, uint64_t done, uint64_t total) {
    EXPECT_LE(done, total);
    return ++asked < stopAt;
  };
  ASSERT_TRUE(placeSteinerCells(balls.sites, balls.radii, densities, {}, progress));
  const uint64_t all = asked;
  EXPECT_GT(all, 100u);
  for (stopAt = 1; stopAt <= all; stopAt += 40) {
    asked = 0;
    const Result<SteinerCells> cells = placeSteinerCells(balls.sites, balls.radii, densities, {}, progress);
    ASSERT_FALSE(cells);
    EXPECT_EQ(cells.error().kind, ErrorKind::kCancelled);
    EXPECT_EQ(asked, stopAt);
  }
}

}  // namespace
}  // namespace froth
