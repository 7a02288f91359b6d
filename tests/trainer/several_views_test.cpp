// A step of several photos takes the mean of what their views ask of the cells.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/reference/scenes.h"
#include "trainer/cpu/cpu_step.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/cpu/view_exchange.h"
#include "trainer/loop/drift_tables.h"

namespace froth {
namespace {

constexpr uint32_t kWidth = 61, kHeight = 43;  // no multiples of a tile
constexpr float kOverlapWeight = 1e-2f;
const glm::dvec3 kLeft(-3, 0.4, 0.3), kFront(0.5, 0.4, -3);

class SeveralViews : public ::testing::Test {
 protected:
  SeveralViews() {
    Foam foam = randomFoam(300, 3, 2, 6);
    for (float& density : foam.densities) density *= 10;  // no view shows all cells
    start_ = storeFoam<float>(foam);
  }

  // Of step `step`, up to keepGradients() or update().
  void differentiate(CpuStep<float>& step, const glm::dvec3& eye, const AdamStep<float>& adam) {
    TrainingView<float> view = trainingView<float>(lookAt(eye, {0.1, 0, 0}, kWidth, kHeight, 0.6));
    view.nearRatio = 1.5f;
    PixelSettings<float> settings;
    settings.perPixel = 1.0f / (kWidth * kHeight);
    settings.normalWeight = 1e-4f;
    const std::vector<glm::vec4> shown = step.render(view, settings, adam);
    std::vector<glm::vec4> gradients(shown.size());
    for (size_t i = 0; i < shown.size(); ++i) {
      gradients[i] = (shown[i] - glm::vec4(0.3f, 0.5f, 0.7f, 0.2f)) / float(shown.size());
    }
    step.differentiate(gradients, std::vector<glm::vec4>(shown.size(), {0.4, 0.5, 0.6, 1}));
  }

  void takeStep(FoamStorage<float>& foam, const std::vector<glm::dvec3>& eyes, uint32_t number) {
    const AdamStep<float> adam = drifts_.adamAt(number);
    CpuStep<float> step(foam);
    step.activate(1e-3f);
    for (const glm::dvec3& eye : eyes) {
      differentiate(step, eye, adam);
      if (eyes.size() > 1) step.keepGradients(adam, kOverlapWeight);
    }
    eyes.size() > 1 ? step.updateByViews(adam) : step.update(adam, kOverlapWeight);
  }

  FoamStorage<float> start_;
  Schedule schedule_;
  Pace pace_{schedule_};
  DriftTables drifts_{pace_};
};

// Cells wait since the step before, which saw the foam from another side.
TEST_F(SeveralViews, TwiceTheSameGiveTheBitsOfOne) {
  takeStep(start_, {kLeft}, 1000);
  const std::vector<uint32_t> first = start_.lastSteps;
  FoamStorage<float> once = start_, twice = start_;
  takeStep(once, {kFront}, 1030);
  takeStep(twice, {kFront, kFront}, 1030);
  size_t shownAgain = 0;
  for (size_t cell = 0; cell < first.size(); ++cell) shownAgain += first[cell] == 1001 && once.lastSteps[cell] == 1031;
  ASSERT_GT(shownAgain, 10u);
  EXPECT_EQ(once.lastSteps, twice.lastSteps);
  for (size_t i = 0; i < kParameterCount; ++i) {
    EXPECT_EQ(once.values[i], twice.values[i]) << kParameterKeys[i];
    EXPECT_EQ(once.firstMoments[i], twice.firstMoments[i]) << kParameterKeys[i];
    EXPECT_EQ(once.secondMoments[i], twice.secondMoments[i]) << kParameterKeys[i];
  }
}

// First moments after the first step are a tenth of the gradients.
TEST_F(SeveralViews, AskForTheMeanOfTheirGradients) {
  FoamStorage<float> left = start_, front = start_, both = start_;
  takeStep(left, {kLeft}, 0);
  takeStep(front, {kFront}, 0);
  takeStep(both, {kLeft, kFront}, 0);
  uint32_t shownByOne = 0;
  for (uint32_t cell = 0; cell < start_.shape.cellCount; ++cell) {
    EXPECT_EQ(both.lastSteps[cell], std::max(left.lastSteps[cell], front.lastSteps[cell])) << cell;
    shownByOne += left.lastSteps[cell] != front.lastSteps[cell];
  }
  EXPECT_GT(shownByOne, 30u);
  for (size_t i = 0; i < kParameterCount; ++i) {
    double squares = 0, differences = 0;
    for (size_t j = 0; j < both.firstMoments[i].size(); ++j) {
      const double mean = 0.5 * (double{left.firstMoments[i][j]} + front.firstMoments[i][j]);
      squares += mean * mean;
      differences += (both.firstMoments[i][j] - mean) * (both.firstMoments[i][j] - mean);
    }
    EXPECT_GT(squares, 0) << kParameterKeys[i];
    EXPECT_LE(std::sqrt(differences / squares), 1e-6) << kParameterKeys[i];
  }
}

// Densification goes by means over photos, however many a step has.
TEST_F(SeveralViews, CountAsManyPhotosInTheMeansOfDensification) {
  FoamStorage<float> apart = start_, together = start_;
  for (const glm::dvec3& eye : {kLeft, kFront}) {
    const AdamStep<float> still{};  // rates of 0
    CpuStep<float> step(apart);
    step.activate(1e-3f);
    differentiate(step, eye, still);
    step.update(still, kOverlapWeight);
  }
  takeStep(together, {kLeft, kFront}, 0);
  EXPECT_EQ(apart.errors, together.errors);
  EXPECT_EQ(apart.contributions, together.contributions);
  EXPECT_NE(start_.contributions, together.contributions);
}

}  // namespace
}  // namespace froth
