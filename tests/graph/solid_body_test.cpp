#include "baker/graph/solid_body.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/graph/ball_sets.h"

namespace froth {
namespace {

double reachFrom(const SolidBody& body, const glm::dvec3& centre) {
  return glm::distance(body.farthestFrom(centre), centre);
}

HalfSpace below(const glm::dvec3& direction, double offset) { return {glm::normalize(direction), offset, 0}; }

TEST(SolidBody, OfABallReachesToTheOppositePole) {
  SolidBody body;
  body.set(1, {});
  EXPECT_NEAR(reachFrom(body, {0, 0, 0}), 1, 1e-12);
  EXPECT_NEAR(reachFrom(body, {0.3, -0.4, 0}), 1.5, 1e-12);
}

TEST(SolidBody, OfACapReachesToItsRimOrItsPole) {
  SolidBody body;
  body.set(1, std::vector{below({0, 0, 1}, -0.8)});
  EXPECT_NEAR(reachFrom(body, {0, 0, -0.8}), 0.6, 1e-12);
  EXPECT_NEAR(reachFrom(body, {0, 0, 0}), 1, 1e-12);
  EXPECT_NEAR(reachFrom(body, {0, 0, 3}), 4, 1e-12);
}

TEST(SolidBody, OfACubeWithinTheBallReachesToItsCorners) {
  std::vector<HalfSpace> cube;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      glm::dvec3 normal(0);
      normal[axis] = sign;
      cube.push_back(below(normal, 0.25));
    }
  }
  SolidBody body;
  body.set(1, cube);
  EXPECT_NEAR(reachFrom(body, {0, 0, 0}), 0.25 * std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(reachFrom(body, {0.25, 0.25, 0.25}), 0.5 * std::sqrt(3.0), 1e-9);
}

TEST(SolidBody, ThatIsEmptyIsAPoint) {
  SolidBody body;
  body.set(1, std::vector{below({1, 0, 0}, -0.5), below({-1, 0, 0}, -0.5)});
  EXPECT_EQ(body.farthestFrom({0, 0, 0}), glm::dvec3(0));
  body.set(1, std::vector{below({1, 0, 0}, -2)});
  EXPECT_EQ(body.farthestFrom({0, 0, 0}), glm::dvec3(0));
}

// The same plane again, and planes that are nearly it, must not cut each other's faces away.
TEST(SolidBody, IsTheSameWithPlanesGivenTwice) {
  for (const double tilt : {0.0, 1e-17, 1e-15, 1e-12, 1e-9}) {
    SolidBody body;
    body.set(1, std::vector{below({0, 0, 1}, -0.6), below({tilt, 0, 1}, -0.6), below({0, tilt, 1}, -0.6 + tilt)});
    EXPECT_NEAR(reachFrom(body, {0, 0, -0.6}), 0.8, 1e-8) << tilt;
    EXPECT_NEAR(reachFrom(body, {0.1, 0, -0.6}), 0.9, 1e-8) << tilt;
  }
}

// Points of random bodies, drawn on the sphere, on planes and inside, against the farthest one.
TEST(SolidBody, ReachesAsFarAsAnyOfItsPoints) {
  BallSetMaker random(5);
  const auto direction = [&] { return glm::normalize(random.pointInCube(-1, 1) + glm::dvec3(1e-9)); };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<HalfSpace> halfSpaces;
    const int count = static_cast<int>(random.uniform(0, 14));
    for (int i = 0; i < count; ++i) halfSpaces.push_back(below(direction(), random.uniform(-0.2, 0.9)));
    SolidBody body;
    body.set(1, halfSpaces);
    const glm::dvec3 centre = random.pointInCube(-0.5, 0.5);
    const double reach = reachFrom(body, centre);
    double most = 0;
    for (int i = 0; i < 4000; ++i) {
      glm::dvec3 point = direction() * (i % 2 == 0 ? 1.0 : random.uniform(0, 1));
      for (const HalfSpace& plane : halfSpaces) {
        point -= std::max(glm::dot(plane.normal, point) - plane.offset, 0.0) * plane.normal;
      }
      if (glm::length(point) > 1) point = glm::normalize(point);
      bool isInside = true;
      for (const HalfSpace& plane : halfSpaces) isInside = isInside && glm::dot(plane.normal, point) <= plane.offset;
      if (isInside) most = std::max(most, glm::distance(point, centre));
    }
    EXPECT_LE(most, reach + 1e-9) << trial;
    if (most > 0) {
      EXPECT_GE(most, 0.8 * reach) << trial;
    }
  }
}

}  // namespace
}  // namespace froth
