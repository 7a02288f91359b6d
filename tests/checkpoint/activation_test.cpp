#include "foam/checkpoint/activation.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace froth {
namespace {

float activate(float raw) { return static_cast<float>(softplus(raw)); }

TEST(Softplus, IsTheIdentityFromAFifthOn) {
  EXPECT_EQ(softplus(0.21), 0.21);
  EXPECT_GT(softplus(0.19), 0.19);
  EXPECT_NEAR(softplus(0.19), 0.19, 1e-10);
}

TEST(InverseSoftplus, ComesBackToTheSameFloatWhereAFloatLeadsThere) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> raw(-0.9f, 0.5f);
  for (int i = 0; i < 100'000; ++i) {
    const float activated = activate(raw(random));
    ASSERT_EQ(activate(inverseSoftplus(activated)), activated);
  }
}

TEST(InverseSoftplus, ComesBackToAnyFloatFromAHundredthOn) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> exponent(-2, 20);
  for (int i = 0; i < 100'000; ++i) {
    const float activated = std::pow(10.0f, exponent(random));
    ASSERT_EQ(activate(inverseSoftplus(activated)), activated);
  }
}

TEST(InverseSoftplus, StaysWithinTheStepsOfFloatForTinyValues) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> exponent(-37, -2);
  for (int i = 0; i < 100'000; ++i) {
    const float activated = std::pow(10.0f, exponent(random));
    const float raw = inverseSoftplus(activated);
    const double units = (100 * std::abs(raw) / 2 + 1) * 0x1p-23;  // half a step of raw, times beta, relative
    ASSERT_NEAR(activate(raw), activated, units * activated) << raw;
  }
}

TEST(InverseSoftplus, KeepsZeroExactly) {
  EXPECT_EQ(activate(inverseSoftplus(0)), 0.0f);
  EXPECT_EQ(std::exp(100 * inverseSoftplus(0)), 0.0f) << "and so in float arithmetic";
  EXPECT_GT(activate(inverseSoftplus(std::numeric_limits<float>::denorm_min())), 0.0f);
}

TEST(NormaliseQuaternion, ChangesNoBitOfWhatItNormalised) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> component(-3, 3);
  for (int i = 0; i < 100'000; ++i) {
    const glm::vec4 once =
        normaliseQuaternion({component(random), component(random), component(random), component(random)});
    ASSERT_NEAR(glm::length(glm::dvec4(once)), 1, 1e-7);
    ASSERT_EQ(normaliseQuaternion(once), once);
  }
}

}  // namespace
}  // namespace froth
