// The tree only saves time: it never hides a ball that a ray meets, nor the nearest one.
#include "foam/site_tree.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <set>

#include "foam/morton_order.h"
#include "tests/graph/ball_sets.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

TEST(SiteTree, FindsTheLeastPowerAndTheNearestBallAsBruteForceDoes) {
  for (const BallSet& balls : makeBallSets(3)) {
    const SiteTree tree(balls.sites, balls.radii, mortonOrder(balls.sites));
    BallSetMaker maker(17);
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 point =
          glm::dvec3(balls.sites[static_cast<size_t>(i) % balls.size()]) + maker.pointInCube(-2, 2);
      double power = HUGE_VAL, surface = HUGE_VAL;
      for (uint32_t k = 0; k < balls.size(); ++k) {
        const glm::dvec3 centre = glm::dvec3(balls.sites[k]) - point;
        power = std::min(power, foam::powerOfOrigin(centre, double{balls.radii[k]}));
        surface = std::min(surface, glm::length(centre) - balls.radii[k]);
      }
      ASSERT_EQ(tree.findLeastPower(point).value, power) << balls.name;
      const NearestSite nearest = tree.findNearestBall(point);
      if (surface < 0) {
        ASSERT_LT(nearest.value, 0) << balls.name;
      } else {
        ASSERT_EQ(nearest.value, surface) << balls.name;
      }
    }
  }
}

template <class Real>
bool meetsBall(const Foam& foam, uint32_t cell, const glm::dvec3& origin, const glm::dvec3& direction) {
  Real tNear, tFar;
  return foam::intersectBall(glm::vec<3, Real>(glm::dvec3(foam.sites[cell]) - origin), Real(foam.radii[cell]),
                             glm::vec<3, Real>(direction), tNear, tFar);
}

std::multiset<uint32_t> visited(const SiteTree& tree, const glm::dvec3& origin, const glm::dvec3& direction) {
  std::multiset<uint32_t> cells;
  tree.searchRay(origin, direction, [&](uint32_t cell) { cells.insert(cell); });
  return cells;
}

TEST(SiteTree, VisitsEveryBallOnARayOnceAndMostOthersNever) {
  Foam foam = randomFoam(1000, 1, 1, 17);
  for (float& radius : foam.radii) radius *= 0.2f;
  const SiteTree tree(foam.sites, foam.radii, mortonOrder(foam.sites));
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  size_t met = 0, visits = 0;
  for (int i = 0; i < 2000; ++i) {
    // Far, near and inside; every third ray runs along an axis.
    const double scale = i % 2 ? 0.8 : 1000;
    const glm::dvec3 origin = scale * glm::dvec3(uniform(random), uniform(random), uniform(random));
    const glm::dvec3 target(uniform(random), uniform(random), uniform(random));
    glm::dvec3 direction = glm::normalize(target - origin);
    if (i % 3 == 0) {
      direction = glm::dvec3(0);
      direction[i % 9 / 3] = i % 4 < 2 ? 1 : -1;
    }
    const std::multiset<uint32_t> cells = visited(tree, origin, direction);
    visits += cells.size();
    for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
      ASSERT_LE(cells.count(cell), 1u);
      if (!meetsBall<double>(foam, cell, origin, direction) && !meetsBall<float>(foam, cell, origin, direction)) {
        continue;
      }
      ASSERT_EQ(cells.count(cell), 1u) << "cell " << cell << ", ray " << i;
      ++met;
    }
  }
  EXPECT_GT(met, 5000u);
  EXPECT_LT(visits, 2000u * foam.cellCount / 20);
}

// As the reference in float has them: a length off by 6e-8 is more than such a ball's radius.
TEST(SiteTree, VisitsSmallBallsFarAwayAlongDirectionsOfFloats) {
  const std::vector<glm::vec3> sites{{-0.6f, 0, 0}, {0.3f, 0.5f, -0.2f}};
  const std::vector<float> radii{0.01f, 0.4f};
  const SiteTree tree(sites, radii, {0, 1});
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 origin = 3000.0 * glm::dvec3(uniform(random), uniform(random), uniform(random));
    const uint32_t aimed = i % 2;
    const glm::dvec3 direction(glm::vec3(glm::normalize(glm::dvec3(sites[aimed]) - origin)));
    ASSERT_EQ(visited(tree, origin, direction).count(aimed), 1u) << i;
  }
}

TEST(SiteTree, HoldsAnyNumberOfCellsAndCoincidentOnes) {
  const std::vector<glm::vec3> sites(100, glm::vec3(1, 2, 3));
  const std::vector<float> radii(100, 0.5f);
  for (uint32_t count : {0u, 1u, 2u, 3u, 5u, 100u}) {
    std::vector<uint32_t> cells(count);
    for (uint32_t i = 0; i < count; ++i) cells[i] = 99 - i;
    const SiteTree tree(sites, radii, cells);
    EXPECT_EQ(visited(tree, {1, 2, 0}, {0, 0, 1}).size(), count);
    EXPECT_EQ(visited(tree, {1, 2, 0}, {0, 0, -1}).size(), 0u);
  }
}

}  // namespace
}  // namespace froth
