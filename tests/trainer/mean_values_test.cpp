// The foam of a run is the mean of what the steps of its last tenth leave.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/reference/scenes.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/loop/cpu_executor.h"
#include "trainer/loop/training_loop.h"

namespace froth {
namespace {

struct ScheduleCase {
  const char* name;
  uint32_t photosPerStep;
  bool isRefinement, isTimed;
};

void PrintTo(const ScheduleCase& c, std::ostream* out) { *out << c.name; }

class AveragedStepsOf : public ::testing::TestWithParam<ScheduleCase> {};

TEST_P(AveragedStepsOf, AreEachEighthPhotoOnceCellsStay) {
  const ScheduleCase& c = GetParam();
  Schedule schedule;
  schedule.steps = 3001;
  schedule.isRefinement = c.isRefinement;
  schedule = spreadSchedule(schedule, c.photosPerStep);
  if (c.isTimed) schedule.seconds = 1000;
  double now = 0;
  Pace pace(schedule, [&now] { return now; });
  uint32_t averaged = 0, photosSince = 0, lastDensified = 0, firstAveraged = UINT32_MAX;
  for (uint32_t step = 0; !pace.isOver(); ++step) {
    const double position = pace.positionAt(step);
    if (isDensifyStep(schedule, step, position)) lastDensified = step;
    if (isAveragedStep(schedule, step, position)) {
      firstAveraged = std::min(firstAveraged, step);
      ++averaged;
      EXPECT_GE(position, c.isRefinement ? 0.8 : 0.9);
    }
    if (position >= (c.isRefinement ? 0.8 : 0.9)) photosSince += c.photosPerStep;
    now += step % 7 == 0 ? 1.9 : 0.23;
    pace.finishStep();
  }
  EXPECT_GT(lastDensified, 0u);
  EXPECT_LT(lastDensified, firstAveraged);
  const double most = std::max(8u, c.photosPerStep);
  EXPECT_NEAR(averaged, photosSince / most, 1);
  EXPECT_GT(averaged, 10u);
}

INSTANTIATE_TEST_SUITE_P(
    Schedules, AveragedStepsOf,
    ::testing::Values(ScheduleCase{"Steps", 1, false, false}, ScheduleCase{"StepsOfThree", 3, false, false},
                      ScheduleCase{"StepsOfSixteen", 16, false, false}, ScheduleCase{"Refinement", 1, true, false},
                      ScheduleCase{"Seconds", 1, false, true}, ScheduleCase{"SecondsOfARefinement", 2, true, true}),
    [](const auto& tested) { return tested.param.name; });

// Two views from two sides of opaque cells, so that some cells wait.
class MeanValues : public ::testing::Test {
 protected:
  static constexpr uint32_t kFirst = 1000;  // steps: rates are past their warm-up

  MeanValues() {
    Foam foam = randomFoam(300, 3, 2, 6);
    for (float& density : foam.densities) density *= 20;
    executor_ = std::make_unique<CpuExecutor>(storeFoam<float>(foam), std::vector{photo(-3), photo(3)});
  }

  static Photo photo(double side) {
    Photo photo;
    photo.view = lookAt({0.4, 0.3, side}, {0, 0, 0}, 61, 43, 0.5);
    photo.view.nearRatio = 1.5;
    for (uint32_t i = 0; i < 61 * 43; ++i) photo.rgba.insert(photo.rgba.end(), {uint8_t(i), 90, uint8_t(i / 61), 255});
    return photo;
  }

  void takeStep(uint32_t photo) {
    const AdamStep<float> adam = drifts_.adamAt(kFirst + steps_++);
    ASSERT_TRUE(executor_->run({{photo}, 0, adam, {}, 1e-3f}));
  }
  FoamStorage<float> read() {
    FoamStorage<float> foam;
    EXPECT_TRUE(executor_->read(foam));
    return foam;
  }
  // Twelve steps, of which four are averaged; the last ones see one side alone.
  void average() {
    for (uint32_t i = 0; i < 12; ++i) {
      takeStep(i < 4 ? i % 2 : 0);
      if (i % 3 != 2) continue;
      ASSERT_TRUE(executor_->average());
      averaged_.push_back(read());
    }
  }

  Schedule schedule_;
  Pace pace_{schedule_};
  DriftTables drifts_{pace_};
  std::unique_ptr<CpuExecutor> executor_;
  uint32_t steps_ = 0;
  std::vector<FoamStorage<float>> averaged_;  // what average() counted
};

TEST_F(MeanValues, AreThoseOfTheStepsThatAreAveraged) {
  average();
  const FoamStorage<float> foam = read();
  EXPECT_EQ(foam.averagedSteps, averaged_.size());
  for (size_t t = 0; t < kParameterCount; ++t) {
    ASSERT_EQ(foam.meanValues[t].size(), foam.values[t].size());
    double fromLast = 0;
    for (size_t i = 0; i < foam.values[t].size(); ++i) {
      double sum = 0, largest = 0;
      for (const FoamStorage<float>& counted : averaged_) {
        sum += counted.values[t][i];
        largest = std::max(largest, std::abs(double{counted.values[t][i]}));
      }
      const double mean = sum / double(averaged_.size());
      // Each fold rounds a difference of two such numbers, its part and a sum: by 2^-24 of 2, 1 and 1 of them.
      ASSERT_NEAR(foam.meanValues[t][i], mean, double(averaged_.size()) * 0x1p-22 * largest) << kParameterKeys[t];
      fromLast = std::max(fromLast, std::abs(mean - foam.values[t][i]) / std::max(largest, 1e-3));
    }
    EXPECT_GT(fromLast, 1e-4) << kParameterKeys[t];
  }
}

TEST_F(MeanValues, BecomeTheValuesAndMoveNoMore) {
  average();
  const FoamStorage<float> before = read();
  FoamStorage<float> caughtUp = before;
  catchUpAll(caughtUp, kFirst + steps_, drifts_);
  ASSERT_NE(caughtUp.values, before.values);  // some wait
  const View view = photo(3).view;
  std::vector<glm::vec4> last, shown, expected;
  const AdamStep<float> adam = drifts_.adamAt(kFirst + steps_);
  ASSERT_TRUE(executor_->show(view, adam, last));

  ASSERT_TRUE(executor_->takeMeans());
  FoamStorage<float> taken = read();
  EXPECT_EQ(taken.values, before.meanValues);
  EXPECT_EQ(taken.averagedSteps, 0u);
  EXPECT_TRUE(taken.meanValues[0].empty());
  ASSERT_TRUE(executor_->show(view, adam, shown));
  EXPECT_NE(shown, last);
  catchUpAll(taken, kFirst + steps_, drifts_);
  EXPECT_EQ(taken.values, before.meanValues);
  std::fill(taken.lastSteps.begin(), taken.lastSteps.end(), kFirst + steps_);  // none waits
  CpuExecutor other(taken, {});
  ASSERT_TRUE(other.show(view, adam, expected));
  EXPECT_EQ(shown, expected);
}

TEST_F(MeanValues, OfNoStepLeaveTheFoamAsItIs) {
  takeStep(0);
  const FoamStorage<float> before = read();
  EXPECT_TRUE(before.meanValues[0].empty());
  ASSERT_TRUE(executor_->takeMeans());
  EXPECT_EQ(read().values, before.values);
  EXPECT_EQ(read().firstMoments, before.firstMoments);
}

TEST_F(MeanValues, AreForgottenWithTheCellsThatTheyAreOf) {
  average();
  const Result<CellFacts> facts = executor_->facts();
  ASSERT_TRUE(facts);
  ASSERT_TRUE(executor_->rearrange(planCells(*facts, 350, {}, 3, 99)));
  EXPECT_EQ(read().averagedSteps, 0u);
  EXPECT_TRUE(read().meanValues[0].empty());
}

}  // namespace
}  // namespace froth
