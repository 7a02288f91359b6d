// Balls against rectangles of rays (shaders/foam/rays.h) against dense samples.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "shaders/foam/cones.h"
#include "shaders/foam/rays.h"

namespace froth::test {
namespace {

using Vec = glm::vec3;

struct Case {
  Vec centre, corner, edgeX, edgeY;
  float radius;
};

// Rectangles before the eye, from a few pixels to a wide lens, and balls all around, some around the eye.
Case makeCase(std::mt19937& engine) {
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto random3 = [&] {
    const float x = unit(engine), y = unit(engine), z = unit(engine);
    return Vec(x, y, z);
  };
  const float size = std::pow(10.0f, unit(engine));
  Case c;
  c.corner = Vec(unit(engine), unit(engine), 1.0f);
  c.edgeX = Vec(size, 0.1f * size * unit(engine), 0.05f * size * unit(engine));
  c.edgeY = Vec(0.1f * size * unit(engine), -size, 0.05f * size * unit(engine));
  c.centre = 3.0f * random3();
  c.radius = std::pow(10.0f, unit(engine) - 0.5f);
  return c;
}

// The largest share of the radius by which a sampled ray misses the ball; negative: it hits.
float nearestMiss(const Case& c, int samples) {
  float least = INFINITY;
  for (int i = 0; i <= samples; ++i) {
    for (int j = 0; j <= samples; ++j) {
      const float s = static_cast<float>(i) / static_cast<float>(samples);
      const float t = static_cast<float>(j) / static_cast<float>(samples);
      const Vec direction = glm::normalize(c.corner + s * c.edgeX + t * c.edgeY);
      const float along = std::max(glm::dot(direction, c.centre), 0.0f);
      least = std::min(least, glm::length(c.centre - along * direction) / c.radius - 1);
    }
  }
  return least;
}

TEST(Rays, ARectangleMeetsABallIfAndOnlyIfOneOfItsRaysDoes) {
  std::mt19937 engine(3);
  int hits = 0, misses = 0;
  for (int i = 0; i < 20000; ++i) {
    const Case c = makeCase(engine);
    const float miss = nearestMiss(c, 12);
    const bool meets = foam::rectangleMeetsBall(c.centre, c.radius, c.corner, c.edgeX, c.edgeY);
    if (miss < 0) {
      ASSERT_TRUE(meets) << "case " << i << ": a ray runs " << -miss << " radii inside";
      ++hits;
    } else if (!meets) {
      ++misses;
    }
    // Samples are up to 1/24 of an edge away from the nearest ray of the rectangle.
    const float edge = std::max(glm::length(c.edgeX), glm::length(c.edgeY));
    const float slack = glm::length(c.centre) / c.radius * edge / 12 + 1e-3f;
    ASSERT_FALSE(meets && miss > slack) << "case " << i << ": all rays miss by " << miss << " radii";
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(misses, 1000);
}

// Around the directions, and around halves of them in turn.
glm::vec4 coneAround(const std::vector<Vec>& directions) {
  Vec sum(0);
  for (const Vec& d : directions) sum += d;
  const Vec axis = glm::normalize(sum);
  float chord = 0;
  for (const Vec& d : directions) chord = std::max(chord, glm::length(d - axis));
  return foam::coneOfChord(axis, chord);
}

TEST(Rays, AConeMeetsEveryBallThatOneOfItsRaysMeetsAndFewMore) {
  std::mt19937 engine(6);
  int hits = 0, misses = 0;
  for (int i = 0; i < 20000; ++i) {
    const Case c = makeCase(engine);
    std::vector<Vec> directions, halves[2];
    for (int k = 0; k < 64; ++k) {
      const float s = static_cast<float>(k % 8) / 7, t = static_cast<float>(k / 8) / 7;
      directions.push_back(glm::normalize(c.corner + 0.3f * (s * c.edgeX + t * c.edgeY)));
      halves[k / 32].push_back(directions.back());
    }
    float nearest = INFINITY;
    for (const Vec& d : directions) {
      const float along = std::max(glm::dot(d, c.centre), 0.0f);
      nearest = std::min(nearest, glm::length(c.centre - along * d) / c.radius - 1);
    }
    const glm::vec4 cone = coneAround(directions), first = coneAround(halves[0]), second = coneAround(halves[1]);
    const Vec axis(cone);
    const glm::vec4 wider =
        foam::guardedCone(axis, std::max(foam::sineToHold(axis, first), foam::sineToHold(axis, second)));
    const float radius = foam::guardedRadius(c.centre, c.radius);
    if (nearest < 0) {
      ASSERT_TRUE(foam::coneMeetsBall(cone, c.centre, radius)) << i;
      ASSERT_TRUE(foam::coneMeetsBall(wider, c.centre, radius)) << i;
      ++hits;
    } else if (!foam::coneMeetsBall(cone, c.centre, radius)) {
      ++misses;
    }
    EXPECT_GE(wider.w, 0.99f * cone.w) << "a cone around cones holds what they hold";
    // A ball that the axis misses by more than the cone's angle and its own.
    const float angle = std::acos(glm::dot(glm::normalize(c.centre), axis));
    if (cone.w < 0.8f && glm::length(c.centre) > 1.01f * c.radius &&
        angle > 1.01f * (std::asin(cone.w) + std::asin(c.radius / glm::length(c.centre))) + 1e-3f) {
      ASSERT_FALSE(foam::coneMeetsBall(cone, c.centre, radius)) << i;
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(misses, 1000);
}

TEST(Rays, ConesOfNothingMeetNothingAndWideOnesAll) {
  const glm::vec4 none(0, 0, 1, foam::kConeOfNone), all(0, 0, 1, foam::kConeOfAll);
  EXPECT_FALSE(foam::coneMeetsBall(none, Vec(0, 0, 1), 5.0f));
  EXPECT_TRUE(foam::coneMeetsBall(all, Vec(0, 0, -9), 0.1f));
  EXPECT_EQ(foam::coneOfChord(Vec(0, 0, 1), 1.2f).w, float(foam::kConeOfAll));
  EXPECT_EQ(foam::sineToHold(Vec(0, 0, 1), none), 0);
  EXPECT_EQ(foam::sineToHold(Vec(0, 0, 1), all), foam::kConeOfAll);
  EXPECT_EQ(foam::sineToHold(Vec(0, 0, 1), glm::vec4(0, 0, -1, 0.1f)), foam::kConeOfAll);
}

TEST(Rays, TheBoundsOfABallsImageHoldEveryRayThatMeetsIt) {
  std::mt19937 engine(4);
  int bounded = 0;
  for (int i = 0; i < 20000; ++i) {
    const Case c = makeCase(engine);
    float low, high;
    if (!foam::boundBallImage(c.centre, c.radius, glm::cross(c.corner, c.edgeY), glm::cross(c.edgeX, c.edgeY), low,
                              high)) {
      continue;
    }
    ++bounded;
    for (int k = 0; k < 32; ++k) {  // rays through points of the ball's silhouette plane
      std::uniform_real_distribution<float> unit(-1, 1);
      const Vec point = c.centre + 0.99f * c.radius * glm::normalize(Vec(unit(engine), unit(engine), unit(engine)));
      // point ~ corner + x edgeX + y edgeY, by Cramer's rule
      const float w = glm::dot(point, glm::cross(c.edgeX, c.edgeY));
      const float x = glm::dot(point, glm::cross(c.edgeY, c.corner)) / w;
      const float slack = 1e-3f * (1 + std::abs(x));
      ASSERT_GE(x, low - slack) << "case " << i;
      ASSERT_LE(x, high + slack) << "case " << i;
    }
  }
  EXPECT_GT(bounded, 1000);
}

TEST(Rays, TheBoundsOfABallsImageAreTheSameInAllUnitsAndHoldForNarrowLenses) {
  const Vec centre(0.3f, -0.2f, 5), corner(-0.5f, -0.4f, 1), edgeX(1e-4f, 0, 0), edgeY(0, 1e-4f, 0);
  const auto widthIn = [&](float unit) {
    float low = 0, high = 0;
    EXPECT_TRUE(foam::boundBallImage(unit * centre, unit * 0.01f, glm::cross(corner, edgeY), glm::cross(edgeX, edgeY),
                                     low, high));
    return high - low;
  };
  const float width = widthIn(1);
  EXPECT_NEAR(width, 40, 1);  // 2 * 0.01 / 5 / 1e-4, and the guard
  for (const float unit : {1e-12f, 1e-7f, 1e-4f, 1e4f, 1e12f}) EXPECT_NEAR(widthIn(unit), width, 0.05f) << unit;
}

}  // namespace
}  // namespace froth::test
