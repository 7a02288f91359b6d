// Bounds of groups against their definition, over random levels.
#include "format/group_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/stream/level_dag.h"

namespace froth::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Corners {
  glm::dvec3 low{kInfinity}, high{-kInfinity};

  void include(const Corners& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
};

// By its definition: the live cells of both forms of a group, and of all that is finer below.
Corners cornersOf(const LevelDag& dag, uint32_t group) {
  Corners corners;
  for (size_t chunk = 0; chunk < dag.levels.size(); ++chunk) {
    const ChunkLevel& place = dag.levels[chunk];
    if (place.in != group && place.madeBy != group) continue;
    const Box& box = dag.liveBoxes[chunk];
    corners.include({{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}});
    if (place.in == group && place.madeBy != kNoGroup) corners.include(cornersOf(dag, place.madeBy));
  }
  return corners;
}

TEST(GroupBounds, AreTheBoxesOfBothFormsAndOfAllThatIsFiner) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    const LevelDag dag = makeLevelDag(seed, {30, 2, 4});
    const std::vector<GroupBounds> bounds = boundGroups(dag.levels, dag.groups, dag.liveBoxes);
    ASSERT_EQ(bounds.size(), dag.groups.size());
    for (uint32_t group = 0; group < bounds.size(); ++group) {
      const Corners corners = cornersOf(dag, group);
      EXPECT_EQ(bounds[group].low, corners.low) << "seed " << seed << ", group " << group;
      EXPECT_EQ(bounds[group].high, corners.high) << "seed " << seed << ", group " << group;
    }
  }
}

// So keys grow towards the floor, whatever threshold.
TEST(GroupBounds, OfCoarserGroupsAreAsNearOrNearer) {
  std::mt19937_64 random(1);
  size_t steps = 0, between = 0;
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    const LevelDag dag = makeLevelDag(seed, {30, 2, 4});
    const std::vector<GroupBounds> bounds = boundGroups(dag.levels, dag.groups, dag.liveBoxes);
    std::uniform_real_distribution<double> uniform(-0.2 * dag.extent, 1.2 * dag.extent);
    for (const ChunkLevel& place : dag.levels) {
      if (place.in == kNoGroup || place.madeBy == kNoGroup) continue;
      for (int k = 0; k < 20; ++k) {
        const glm::dvec3 eye(uniform(random), uniform(random), 0.2 * uniform(random));
        const double coarser = distanceTo(bounds[place.in], eye), finer = distanceTo(bounds[place.madeBy], eye);
        EXPECT_LE(coarser, finer) << "seed " << seed;
        ++steps;
        between += coarser < finer ? 1 : 0;
      }
    }
  }
  EXPECT_GT(between, steps / 10);
}

// The nearest of a grid of points of the box is within half of the grid's diagonal.
TEST(GroupBounds, AreAsFarAsTheNearestPointOfTheBox) {
  constexpr int kAlong = 30;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-2, 2);
  size_t outside = 0;
  for (int k = 0; k < 100; ++k) {
    const glm::dvec3 a(uniform(random), uniform(random), uniform(random));
    const glm::dvec3 b(uniform(random), uniform(random), uniform(random)),
        eye = 2.0 * glm::dvec3(uniform(random), uniform(random), uniform(random));
    const GroupBounds bounds{glm::min(a, b), glm::max(a, b)};
    const glm::dvec3 step = (bounds.high - bounds.low) / double{kAlong - 1};
    double nearest = kInfinity;
    for (int x = 0; x < kAlong; ++x) {
      for (int y = 0; y < kAlong; ++y) {
        for (int z = 0; z < kAlong; ++z) {
          nearest = std::min(nearest, glm::distance(eye, bounds.low + step * glm::dvec3(x, y, z)));
        }
      }
    }
    EXPECT_LE(distanceTo(bounds, eye), nearest + 1e-12);
    EXPECT_GE(distanceTo(bounds, eye), nearest - 0.5 * glm::length(step));
    outside += distanceTo(bounds, eye) > 0 ? 1 : 0;
  }
  EXPECT_GT(outside, 20u);
}

TEST(GroupBounds, AreAtNoDistanceFromAnEyeInside) {
  const GroupBounds bounds{{-1, -1, -1}, {1, 1, 1}};
  EXPECT_EQ(distanceTo(bounds, {0, 0, 0}), 0);
  EXPECT_EQ(distanceTo(bounds, {0.9, -0.5, 1}), 0);
  EXPECT_DOUBLE_EQ(distanceTo(bounds, {3, 0, 0}), 2);                          // from a face
  EXPECT_DOUBLE_EQ(distanceTo(bounds, {0, -4, 3}), std::hypot(4 - 1, 3 - 1));  // an edge
  EXPECT_DOUBLE_EQ(distanceTo(bounds, {-2, 2, 2}), std::sqrt(3.0));            // a corner
}

// Chunk 0 is the floor, of chunk 1; no cell is live, or only those of chunk 1.
TEST(GroupBounds, WithoutLiveCellsAreAPoint) {
  const std::vector<ChunkLevel> levels{{1, 0, kNoGroup}, {0, kNoGroup, 0}};
  const std::vector<LevelGroup> groups{{{3, 4, 0}, 1, 0.1, 0}};
  const Box none, some = placeBox({10, 20, 30}, {{-1, -2, -3}, {1, 2, 3}});
  EXPECT_DOUBLE_EQ(distanceTo(boundGroups(levels, groups, std::vector{none, none})[0], {0, 0, 0}), 5);
  const GroupBounds bounds = boundGroups(levels, groups, std::vector{placeBox({10, 20, 30}, none), some})[0];
  EXPECT_EQ(bounds.low, glm::dvec3(9, 18, 27));
  EXPECT_EQ(bounds.high, glm::dvec3(11, 22, 33));
}

}  // namespace
}  // namespace froth::test
