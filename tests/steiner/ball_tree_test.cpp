#include <gtest/gtest.h>

#include "baker/steiner/ball_tree.h"
#include "shaders/foam/cell.h"
#include "tests/graph/ball_sets.h"

namespace froth {
namespace {

TEST(BallTree, FindsTheLeastPowerAndTheNearestSurfaceAsBruteForceDoes) {
  for (const BallSet& balls : makeBallSets(3)) {
    const BallTree tree(balls.sites, balls.radii);
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
      ASSERT_EQ(tree.nearestPower(point).value, power) << balls.name;
      const BallTree::Nearest nearest = tree.nearestSurface(point);
      if (surface < 0) {
        ASSERT_LT(nearest.value, 0) << balls.name;
      } else {
        ASSERT_EQ(nearest.value, surface) << balls.name;
      }
    }
  }
}

}  // namespace
}  // namespace froth
