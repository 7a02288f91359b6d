// Cells that no pixel shows wait, also those that the tiles of a view see behind others; what waited is as dense Adam
// would have it.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/reference/scenes.h"
#include "trainer/cpu/cpu_step.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/cpu/view_exchange.h"
#include "trainer/loop/drift_tables.h"
#include "trainer/loop/training_loop.h"

namespace froth {
namespace {

constexpr uint32_t kWidth = 61, kHeight = 43;
constexpr uint32_t kFirst = 1000, kShown = 4, kHidden = 20;  // steps: rates are past their warm-up

std::vector<glm::vec4> gradientsFor(const std::vector<glm::vec4>& shown) {
  std::vector<glm::vec4> gradients(shown.size());
  for (size_t i = 0; i < shown.size(); ++i) {
    gradients[i] = (shown[i] - glm::vec4(0.3f, 0.5f, 0.7f, 0.2f)) / float(shown.size());
  }
  return gradients;
}

//     eye of `front` ->  ||||| opaque cells |||||  <- eye of `back`
//
// Some steps show the cells in the back, then many those in front. Tiles see all of them.
class Waiting : public ::testing::Test {
 protected:
  Waiting() {
    Foam foam = randomFoam(300, 3, 2, 6);
    for (float& density : foam.densities) density *= 20;
    foam_ = storeFoam<float>(foam);
    for (uint32_t i = 0; i < kShown; ++i) takeStep(step_, kFirst + i, back_);
    const std::vector<uint32_t> shown = foam_.lastSteps;
    before_ = foam_;
    std::vector<bool> isHidden(foam.cellCount, true);
    for (uint32_t i = 0; i < kHidden; ++i) {
      takeStep(step_, kFirst + kShown + i, front_);
      for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
        const uint32_t rank = step_.seen().rankOf[cell];
        const bool isSeen = rank != SeenCells<float>::kNotSeen;
        isHidden[cell] = isHidden[cell] && isSeen && step_.sums().cells[rank].contribution == 0;
      }
    }
    for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
      if (isHidden[cell] && shown[cell] == kFirst + kShown) hidden_.push_back(cell);
    }
  }

  void takeStep(CpuStep<float>& step, uint32_t number, const TrainingView<float>& view) {
    PixelSettings<float> settings;
    settings.perPixel = 1.0f / (kWidth * kHeight);
    const AdamStep<float> adam = drifts_.adamAt(number);
    step.activate(1e-3f);
    const std::vector<glm::vec4> shown = step.render(view, settings, adam);
    step.differentiate(gradientsFor(shown), std::vector<glm::vec4>(shown.size(), glm::vec4(0.3, 0.5, 0.7, 1)));
    step.update(adam, 1e-4f);
  }

  // One number of a cell after the steps that hid it, as Adam moves it step by step without a gradient.
  double moveDensely(Parameter parameter, size_t i) const {
    const auto index = static_cast<size_t>(parameter);
    double value = before_.values[index][i], first = before_.firstMoments[index][i],
           second = before_.secondMoments[index][i];
    for (uint32_t number = kFirst + kShown; number < kFirst + kShown + kHidden; ++number) {
      const double root = std::sqrt(1 - std::pow(kBeta2, number + 1));
      const double rate =
          rateAt(schedule_, parameter, pace_.positionAt(number)) * root / (1 - std::pow(kBeta1, number + 1));
      updateValue<double>(value, first, second, 0, rate, kEpsilon * root);
    }
    return value;
  }

  const TrainingView<float> back_ = trainingView<float>(lookAt({-0.5, 0.2, 3}, {0, 0, 0}, kWidth, kHeight, 0.5));
  const TrainingView<float> front_ = trainingView<float>(lookAt({0.5, 0.4, -3}, {0, 0, 0}, kWidth, kHeight, 0.5));
  Schedule schedule_;
  Pace pace_{schedule_};
  DriftTables drifts_{pace_};
  FoamStorage<float> foam_, before_;
  CpuStep<float> step_{foam_};
  std::vector<uint32_t> hidden_;  // seen in all later steps and shown by no pixel, but shown just before
};

TEST_F(Waiting, CellsBehindOthersAreStoredAsTheLastStepLeftThemThatShowedThem) {
  ASSERT_GT(hidden_.size(), 20u);
  for (const uint32_t cell : hidden_) {
    EXPECT_EQ(foam_.lastSteps[cell], kFirst + kShown);
    for (size_t t = 0; t < kParameterCount; ++t) {
      if (!isWaiting(static_cast<Parameter>(t))) continue;
      const uint32_t width = widthOf(static_cast<Parameter>(t), foam_.shape);
      for (size_t i = cell * width; i < (cell + 1) * width; ++i) {
        EXPECT_EQ(foam_.values[t][i], before_.values[t][i]);
        EXPECT_EQ(foam_.secondMoments[t][i], before_.secondMoments[t][i]);
      }
    }
  }
}

TEST_F(Waiting, CellsAreReadAsDenseAdamWouldHaveThem) {
  const AdamStep<float> adam = drifts_.adamAt(kFirst + kShown + kHidden);
  const TrainedFoam<float> view = viewStorage(foam_);
  double moved = 0;
  for (const uint32_t cell : hidden_) {
    const TrainedCell<float> trained(view, adam, cell);
    for (size_t t = 0; t < kParameterCount; ++t) {
      const auto parameter = static_cast<Parameter>(t);
      if (!isWaiting(parameter)) continue;
      const uint32_t width = widthOf(parameter, foam_.shape);
      for (size_t i = size_t{cell} * width; i < size_t{cell + 1} * width; ++i) {
        const double expected = moveDensely(parameter, i), drift = std::abs(expected - before_.values[t][i]);
        // Epsilon is that of the first step of the wait; up to the tenth, the mean, it grows by 0.8 %.
        const double epsilonShare = kEpsilon / (std::sqrt(before_.secondMoments[t][i]) + kEpsilon);
        const double tolerance = 1e-5 * (1 + std::abs(expected)) + 0.01 * epsilonShare * drift;
        ASSERT_NEAR(trained.part(parameter).read(static_cast<uint32_t>(i % width)), expected, tolerance)
            << kParameterKeys[t];
        moved = std::max(moved, drift);
      }
    }
  }
  EXPECT_GT(moved, 0.01);
}

double largestDifference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
  float largest = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    for (int c = 0; c < 4; ++c) largest = std::max(largest, std::abs(a[i][c] - b[i][c]));
  }
  return largest;
}

double relativeDifference(const std::vector<float>& expected, const std::vector<float>& found) {
  double squares = 0, differences = 0;
  for (size_t i = 0; i < expected.size(); ++i) {
    squares += double{expected[i]} * expected[i];
    differences += (double{found[i]} - expected[i]) * (double{found[i]} - expected[i]);
  }
  return std::sqrt(differences / squares);
}

TEST_F(Waiting, CellsAreShownAndUpdatedAsThoseThatCaughtUp) {
  constexpr uint32_t kNext = kFirst + kShown + kHidden;
  FoamStorage<float> caughtUp = foam_, stale = foam_;
  catchUpAll(caughtUp, kNext, drifts_);
  std::fill(stale.lastSteps.begin(), stale.lastSteps.end(), kNext);
  const AdamStep<float> adam = drifts_.adamAt(kNext);
  const auto show = [&](FoamStorage<float>& foam) {
    CpuStep<float> step(foam);
    step.activate(1e-3f);
    return std::vector<glm::vec4>(step.render(back_, {}, adam));
  };
  const std::vector<glm::vec4> shown = show(foam_);
  EXPECT_LE(largestDifference(shown, show(caughtUp)), 1e-5);
  EXPECT_GT(largestDifference(shown, show(stale)), 1e-3);
  CpuStep<float> other(caughtUp);
  takeStep(step_, kNext, back_);
  takeStep(other, kNext, back_);
  catchUpAll(foam_, kNext + 1, drifts_);  // those that wait on
  catchUpAll(caughtUp, kNext + 1, drifts_);
  EXPECT_EQ(foam_.lastSteps, caughtUp.lastSteps);
  for (size_t t = 0; t < kParameterCount; ++t) {
    EXPECT_LE(relativeDifference(caughtUp.values[t], foam_.values[t]), 1e-4) << kParameterKeys[t];
    EXPECT_LE(relativeDifference(caughtUp.firstMoments[t], foam_.firstMoments[t]), 1e-3) << kParameterKeys[t];
    EXPECT_LE(relativeDifference(caughtUp.secondMoments[t], foam_.secondMoments[t]), 1e-3) << kParameterKeys[t];
  }
}

}  // namespace
}  // namespace froth
