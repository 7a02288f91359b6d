// Lengths far from the cameras count in larger units.
#include "trainer/step/eyes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/reference/scenes.h"
#include "trainer/cpu/cpu_step.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/cpu/view_exchange.h"
#include "trainer/loop/schedule.h"

namespace froth {
namespace {

constexpr uint32_t kWidth = 61, kHeight = 43;
const Eyes kOneEye{glm::vec3(0), 0};

// In front of an eye at 0. At any distance it shows the same there.
FoamStorage<double> foamAt(float distance) {
  constexpr float kInFront = 8;
  Foam foam = randomFoam(300, 3, 2, 6);
  const float scale = distance / kInFront;
  for (glm::vec3& site : foam.sites) site = scale * (site + glm::vec3(0, 0, kInFront));
  for (float& radius : foam.radii) radius *= scale;
  foam.densities.assign(foam.cellCount, 20 / scale);
  return storeFoam<double>(foam);
}

// What the last of so many steps shows, each of which draws the image towards one colour. In double, for Adam's steps
// follow the sign of gradients that are rounding alone.
std::vector<glm::dvec4> imageAfter(FoamStorage<double> foam, uint32_t steps, const Eyes& eyes) {
  const std::vector<double> noDrifts(steps);
  AdamStep<double> adam;
  adam.eyes = eyes;
  adam.epsilon = 1e-30;  // of none of the scales
  for (size_t i = 0; i < kParameterCount; ++i) {
    adam.rates[i] = 0.05 * rateAt({}, static_cast<Parameter>(i), 0.2);  // softplus stays linear
    adam.drifts[i] = noDrifts.data();
  }
  PixelSettings<double> settings;
  settings.perPixel = 1.0 / (kWidth * kHeight);
  CpuStep<double> step(foam);
  std::vector<glm::dvec4> shown;
  for (adam.step = 1; adam.step <= steps; ++adam.step) {
    step.activate(1e-3f);
    shown = step.render(trainingView<double>(lookAt({0, 0, 0}, {0, 0, 1}, kWidth, kHeight, 0.6)), settings, adam);
    std::vector<glm::dvec4> gradients(shown.size());
    for (size_t pixel = 0; pixel < shown.size(); ++pixel) {
      gradients[pixel] = (shown[pixel] - glm::dvec4(0.3, 0.5, 0.7, -1)) / double(shown.size());
    }
    step.differentiate(gradients, std::vector<glm::dvec4>(shown.size(), {0.4, 0.5, 0.6, 1}));
    step.update(adam, 1e-4);
  }
  return shown;
}

double rootMeanSquare(const std::vector<glm::dvec4>& a, const std::vector<glm::dvec4>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += glm::dot(glm::dvec3(a[i] - b[i]), glm::dvec3(a[i] - b[i]));
  return std::sqrt(sum / (3.0 * double(a.size())));
}

TEST(Eyes, UnitsGrowWithTheDistanceFromTheCameras) {
  const Eyes eyes{{1, 2, 3}, 2};
  EXPECT_EQ(unitAt(eyes, glm::vec4(1, 2, 3, 0.1f)), 1);
  EXPECT_EQ(unitAt(eyes, glm::vec4(1, 2, 9, 0.1f)), 1);  // kNearDistance beyond them
  EXPECT_FLOAT_EQ(unitAt(eyes, glm::vec4(1, 2, 45, 0.1f)), 10);
  EXPECT_EQ(unitAt(Eyes{}, glm::vec4(1e9f, 0, 0, 0.1f)), 1);
}

TEST(Eyes, WhatLooksTheSameLearnsTheSame) {
  constexpr uint32_t kSteps = 30;
  const std::vector<glm::dvec4> first = imageAfter(foamAt(32), 1, kOneEye),
                                near = imageAfter(foamAt(32), kSteps, kOneEye),
                                far = imageAfter(foamAt(128), kSteps, kOneEye),
                                slow = imageAfter(foamAt(128), kSteps, Eyes{});
  const double learned = rootMeanSquare(first, near);
  EXPECT_GT(learned, 0.02);
  EXPECT_EQ(rootMeanSquare(near, far), 0);  // powers of two apart
  EXPECT_GT(rootMeanSquare(near, slow), 0.2 * learned);
}

}  // namespace
}  // namespace froth
