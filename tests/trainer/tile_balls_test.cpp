// No ball that a ray meets is missed, and few others are taken for one.
#include "trainer/cpu/tile_balls.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "shaders/foam/cell.h"
#include "shaders/foam/rays.h"

namespace froth {
namespace {

glm::vec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
}

// Balls at a distance at which rounding counts, each of which the ray nearly touches, from within or without.
TEST(TileBalls, AreMetByARayThatMeetsThem) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  constexpr uint32_t kBlock = TileBalls<float>::kBlock, kBalls = 2 * kBlock + 5;
  std::vector<uint32_t> ranks(kBalls);
  std::iota(ranks.rbegin(), ranks.rend(), 0u);  // not their order
  uint32_t met = 0, taken = 0, all = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 ray = randomDirection(random);
    std::vector<glm::vec3> centres;
    std::vector<float> radii;
    std::vector<glm::vec4> guarded;
    for (uint32_t k = 0; k < kBalls; ++k) {
      const glm::vec3 across = glm::normalize(glm::cross(ray, randomDirection(random)));
      const float radius = std::exp(-7 * unit(random)), distance = 1 + 1000 * unit(random);
      const float past = k % 2 == 0 ? 1e-5f * (unit(random) - 0.5f) : 2 * unit(random) - 1;
      centres.push_back(distance * ray + radius * (1 + past) * across);
      radii.push_back(radius);
      const float guard = foam::guardedRadius(centres.back(), radius);
      guarded.emplace_back(centres.back(), guard * guard);
    }
    TileBalls<float> balls;
    balls.take(guarded, ranks);
    ASSERT_EQ(balls.blockCount(), 3u);
    for (uint32_t place = 0; place < 3 * kBlock; ++place) {
      const bool mayMeet = (balls.mayMeet(place / kBlock, ray) >> place % kBlock & 1) != 0;
      if (place >= kBalls) {
        EXPECT_FALSE(mayMeet) << place;
        continue;
      }
      float near, far;
      const bool isMet = foam::intersectBall(centres[ranks[place]], radii[ranks[place]], ray, near, far);
      ASSERT_LE(isMet, mayMeet) << i << ", " << place;
      met += isMet;
      if (ranks[place] % 2 == 0) continue;
      ++all;
      taken += mayMeet && !isMet;
    }
  }
  EXPECT_GT(met, 30'000u);
  EXPECT_LT(taken, 0.2 * all);
}

}  // namespace
}  // namespace froth
