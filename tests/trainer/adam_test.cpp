// Parameters that wait drift as dense Adam would have moved them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "trainer/cpu/foam_storage.h"
#include "trainer/loop/drift_tables.h"
#include "trainer/step/trained_cell.h"

namespace froth {
namespace {

struct WaitCase {
  const char* name;
  double gradient;   // how large
  double tolerance;  // of a value
};

void PrintTo(const WaitCase& c, std::ostream* out) { *out << c.name; }

class AdamOf : public ::testing::TestWithParam<WaitCase> {};

TEST_P(AdamOf, ParametersThatWaitEqualsDenseAdam) {
  Schedule schedule;
  schedule.steps = 1500;
  std::mt19937_64 random(3);
  const auto parameter = Parameter::kLobeAxes;
  const auto index = static_cast<size_t>(parameter);
  const Pace pace(schedule);
  DriftTables drifts(pace);
  FoamStorage<float> storage;  // of one cell, which waits
  resizeStorage(storage, {1, 1, 1});
  const TrainedFoam<float> foam = viewStorage(storage);
  float &value = storage.values[index][0], &second = storage.secondMoments[index][0];
  value = 0.5f;
  double denseValue = 0.5, denseFirst = 0, denseSecond = 0;  // does not
  for (uint32_t step = 0; step < schedule.steps; ++step) {
    const AdamStep<float> adam = drifts.adamAt(step);
    const bool isShown = random() % 9 == 0 && !(step > 400 && step < 1000);  // among others 600 steps long not
    const double gradient = isShown ? GetParam().gradient * std::normal_distribution<double>(1)(random) : 0.0;
    const double correction = std::sqrt(1 - std::pow(0.999, step + 1)) / (1 - std::pow(0.9, step + 1));
    updateValue<double>(denseValue, denseFirst, denseSecond, gradient,
                        rateAt(schedule, parameter, pace.positionAt(step)) * correction,
                        1e-15 * std::sqrt(1 - std::pow(0.999, step + 1)));
    if (!isShown) continue;
    TrainedCell<float>(foam, adam, 0).part(parameter).update(0, static_cast<float>(gradient));
    foam.lastSteps[0] = adam.step;
    ASSERT_NEAR(value, denseValue, GetParam().tolerance * (1 + std::abs(denseValue))) << step;
    ASSERT_NEAR(second, denseSecond, 1e-4 * denseSecond) << step;
  }
  EXPECT_GT(std::abs(denseValue - 0.5), 0.1);  // something happened
}

// The second is like epsilon.
INSTANTIATE_TEST_SUITE_P(Gradients, AdamOf,
                         ::testing::Values(WaitCase{"Usual", 1e-9, 2e-5}, WaitCase{"Tiny", 1e-15, 2e-2}),
                         [](const auto& tested) { return tested.param.name; });

TEST(Adam, RateOfTheFirstStepObeysTheWarmUp) {
  const Schedule schedule;
  EXPECT_EQ(rateAt(schedule, Parameter::kDensity, 0), 0);
  EXPECT_EQ(rateAt(schedule, Parameter::kRadii, 0), 0);
  EXPECT_EQ(rateAt(schedule, Parameter::kPoints, 0), 1e-3);
  EXPECT_NEAR(rateAt(schedule, Parameter::kPoints, 1), 2e-4, 1e-12);
  EXPECT_EQ(rateAt(schedule, Parameter::kDensity, 0.5), 1);
}

TEST(Adam, RatesNeverGrowAfterTheWarmUp) {
  for (const RatePreset preset : {RatePreset::kIndoor, RatePreset::kOutdoor}) {
    Schedule schedule;
    schedule.preset = preset;
    for (size_t i = 0; i < kParameterCount; ++i) {
      const auto parameter = static_cast<Parameter>(i);
      const bool isConstant = parameter == Parameter::kDensity;
      for (double position = 0.1; position < 0.99; position += 0.1) {
        const double share = rateAt(schedule, parameter, position + 0.1) / rateAt(schedule, parameter, position);
        EXPECT_GT(share, 0.5) << kParameterKeys[i];
        EXPECT_LE(share, isConstant ? 1 : 0.999) << kParameterKeys[i];
      }
    }
  }
}

TEST(Adam, ARefinementHasTheRatesOfTheSecondHalf) {
  const Schedule whole;
  Schedule refinement = whole;
  refinement.isRefinement = true;
  for (const double position : {0.2, 1.0}) {
    for (const Parameter parameter : {Parameter::kPoints, Parameter::kRadii, Parameter::kDetailHeights}) {
      EXPECT_NEAR(rateAt(refinement, parameter, position) / rateAt(whole, parameter, 0.5 + 0.5 * position), 1, 1e-12);
    }
    EXPECT_EQ(halvingsAt(refinement, position), 0u);
  }
  EXPECT_EQ(rateAt(refinement, Parameter::kPoints, 0), 0);
  EXPECT_EQ(halvingsAt(refinement, 0), 0u);
}

// In fewer than a hundred steps Adam's moments do not fill: rates stay low, and the foam near what it was.
TEST(Adam, AShortRefinementKeepsLowRates) {
  Schedule longer, shorter;
  longer.isRefinement = shorter.isRefinement = true;
  shorter.steps = 50;
  for (const double position : {0.2, 0.6, 1.0}) {
    const double share = rateAt(shorter, Parameter::kPoints, position) / rateAt(longer, Parameter::kPoints, position);
    EXPECT_NEAR(share, position / 2, 1e-12);
  }
  shorter.seconds = 1;
  EXPECT_EQ(rateAt(shorter, Parameter::kPoints, 0.2), rateAt(longer, Parameter::kPoints, 0.2));
}

TEST(Schedule, SpreadOverStepsOfSeveralPhotosSeesAsManyPhotos) {
  Schedule one;
  one.steps = 1001;
  const Schedule four = spreadSchedule(one, 4), same = spreadSchedule(one, 1);
  EXPECT_EQ(four.steps, 251u);
  EXPECT_EQ(same.steps, 1001u);
  for (const double position : {0.01, 0.3, 1.0}) {
    EXPECT_EQ(rateAt(four, Parameter::kRadii, position), 2 * rateAt(one, Parameter::kRadii, position));
    EXPECT_EQ(rateAt(same, Parameter::kRadii, position), rateAt(one, Parameter::kRadii, position));
  }
  for (const uint32_t photosPerStep : {1u, 3u, 4u, 16u}) {
    const Schedule spread = spreadSchedule(one, photosPerStep);
    uint32_t times = 0;
    for (uint32_t step = 0; step * photosPerStep < 900; ++step) times += isDensifyStep(spread, step, 0.5);
    EXPECT_EQ(times, 9u) << photosPerStep;
  }
}

}  // namespace
}  // namespace froth
