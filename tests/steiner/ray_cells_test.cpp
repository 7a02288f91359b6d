#include <gtest/gtest.h>

#include "baker/graph/graph.h"
#include "baker/steiner/ray_cells.h"
#include "foam/morton_order.h"
#include "tests/graph/ball_sets.h"

namespace froth {
namespace {

struct Scene {
  BallSet balls = BallSetMaker(4).foamLike(600, 0);
  std::vector<float> densities = std::vector<float>(balls.size(), 0);  // nothing ends a walk
  std::vector<WalkRay> rays;

  Scene() {
    BallSetMaker maker(11);
    for (int i = 0; i < 100; ++i) {
      WalkRay ray;
      ray.origin = glm::dvec3(balls.sites[static_cast<size_t>(i)]) + maker.pointInCube(-1, 1);
      ray.direction = ray.forward = glm::normalize(maker.pointInCube(-1, 1) + glm::dvec3(1e-3));
      rays.push_back(ray);
    }
  }

  RayCells cellsOf(const SiteTree& tree, const WalkRay& ray) const {
    return RayCells(tree, balls.sites, balls.radii, densities, ray);
  }
};

TEST(RayCells, AreAsManyAsAWalkOverTheTriangulationCrosses) {
  const Scene scene;
  const SiteTree tree(scene.balls.sites, scene.balls.radii, mortonOrder(scene.balls.sites));
  size_t counted = 0;
  for (const WalkRay& ray : scene.rays) counted += scene.cellsOf(tree, ray).count();
  const RegularTriangulation triangulation = *triangulateRegular(scene.balls.sites, scene.balls.radii);
  const WalkLength walked =
      measureWalkLength({scene.balls.sites, scene.balls.radii, scene.densities, {}}, triangulation.graph, scene.rays);
  // The walk goes on where nothing but unbounded cells is left.
  EXPECT_LE(counted, walked.steps);
  EXPECT_GT(static_cast<double>(counted), 0.93 * static_cast<double>(walked.steps));
  EXPECT_GT(walked.meanSteps(), 5);
}

TEST(RayCells, WithAnAddedBallAreThoseOfASceneThatHoldsIt) {
  Scene scene;
  const SiteTree before(scene.balls.sites, scene.balls.radii, mortonOrder(scene.balls.sites));
  std::vector<RayCells> walks;
  for (const WalkRay& ray : scene.rays) walks.push_back(scene.cellsOf(before, ray));
  BallSetMaker maker(3);
  const glm::vec3 site(maker.pointInCube(0, 1) + glm::dvec3(scene.balls.sites[7]));
  const float radius = 3 * scene.balls.radii[7];
  scene.balls.add(site, radius);
  scene.densities.push_back(0);
  const SiteTree after(scene.balls.sites, scene.balls.radii, mortonOrder(scene.balls.sites));
  int crossed = 0;
  for (size_t i = 0; i < scene.rays.size(); ++i) {
    const BallLine line = lineOf(site, radius, scene.rays[i]);
    const size_t expected = scene.cellsOf(after, scene.rays[i]).count();
    EXPECT_EQ(walks[i].count() - static_cast<size_t>(walks[i].savingOf(line)), expected) << i;
    crossed += walks[i].isCutBy(line);
    walks[i].add(line);
    EXPECT_EQ(walks[i].count(), expected) << i;
  }
  EXPECT_GT(crossed, 5);
}

TEST(RayCells, EmptyIntervalsLieOutsideAllBalls) {
  const Scene scene;
  const SiteTree tree(scene.balls.sites, scene.balls.radii, mortonOrder(scene.balls.sites));
  size_t found = 0;
  for (const WalkRay& ray : scene.rays) {
    for (const RayCells::Interval& interval : scene.cellsOf(tree, ray).emptyIntervals()) {
      ASSERT_LT(interval.begin, interval.end);
      const double middle = 0.5 * (interval.begin + interval.end);
      EXPECT_GT(tree.findNearestBall(glm::dvec3(ray.origin) + middle * glm::dvec3(ray.direction)).value, 0);
      ++found;
    }
  }
  EXPECT_GT(found, 100u);
}

}  // namespace
}  // namespace froth
