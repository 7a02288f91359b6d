// A run's schedule follows its steps, or the time that they take. No test here reads a real clock.
#include "trainer/loop/pace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "foam/foam_arrays.h"
#include "tests/training/gallery_capture.h"
#include "trainer/loop/drift_tables.h"

namespace froth {
namespace {

namespace fs = std::filesystem;

TEST(Pace, BySteps) {
  Schedule schedule;
  schedule.steps = 7;
  Pace pace(schedule);
  for (uint32_t step = 0; step < 7; ++step) {
    EXPECT_FALSE(pace.isOver());
    EXPECT_EQ(pace.stepsDone(), step);
    EXPECT_EQ(pace.positionAt(step), step / 7.0);
    pace.finishStep();
  }
  EXPECT_TRUE(pace.isOver());
}

TEST(Pace, ByTheTimeOfStepsAlone) {
  Schedule schedule;
  schedule.seconds = 16;
  double now = 1000;
  Pace pace(schedule, [&] { return now; });
  now += 1;
  pace.finishStep();
  now += 0.5;  // the step was not done yet
  pace.pause();
  now += 100;
  pace.goOn();
  EXPECT_EQ(pace.positionAt(1), 1.5 / 16);
  now += 14.25;
  pace.finishStep();
  EXPECT_EQ(pace.positionAt(2), 15.75 / 16);
  EXPECT_FALSE(pace.isOver());
  now += 5;
  pace.finishStep();
  EXPECT_EQ(pace.positionAt(3), 1);
  EXPECT_TRUE(pace.isOver());

  const Pace resumed(
      schedule, [] { return 0; }, pace.seconds());
  EXPECT_EQ(resumed.stepsDone(), 3u);
  EXPECT_TRUE(resumed.isOver());
  EXPECT_EQ(resumed.positionAt(1), pace.positionAt(1));
}

// D of trainer/step/adam.h, summed up by its definition.
TEST(Pace, DriftsHaveTheRatesThatStepsHad) {
  Schedule schedule;
  schedule.seconds = 1000;
  double now = 0;
  Pace pace(schedule, [&] { return now; });
  DriftTables drifts(pace);
  for (uint32_t step = 0; step < 90; ++step) {
    drifts.adamAt(step);
    now += step < 60 ? 1 : 30;
    pace.finishStep();
  }
  const AdamStep<float> adam = drifts.adamAt(90);
  const auto parameter = Parameter::kLobeAxes;
  for (const uint32_t waitsSince : {10u, 59u, 61u, 85u}) {
    double drift = 0;
    for (uint32_t number = waitsSince + 1; number <= 90; ++number) {
      const double correction = std::sqrt(1 - std::pow(kBeta2, number)) / (1 - std::pow(kBeta1, number));
      drift += rateAt(schedule, parameter, pace.positionAt(number - 1)) * correction *
               std::pow(kBeta1 / std::sqrt(kBeta2), number - waitsSince);
    }
    EXPECT_NEAR(adam.drifts[static_cast<size_t>(parameter)][waitsSince] / drift, 1, 1e-6) << waitsSince;
  }
}

// What steps were asked for, and a clock that they alone move: steps at full size take four times as long as those at a
// quarter of it, and in proportion to the number of cells.
struct Watch {
  double now = 500, lastStep = 0;
  std::vector<StepPlan> plans;
  std::vector<FoamStorage<float>> averaged;  // as the steps left them
  uint32_t rearrangedSince = 0;              // the first was averaged
};

class WatchedExecutor : public StepExecutor {
 public:
  WatchedExecutor(std::unique_ptr<StepExecutor> executor, Watch& watch)
      : executor_(std::move(executor)), watch_(watch) {}

  Status run(const StepPlan& plan) override {
    watch_.lastStep = (4 >> plan.halvings) * cellCount() / 300.0;
    watch_.now += watch_.lastStep;
    watch_.plans.push_back(plan);
    return executor_->run(plan);
  }
  Status rearrange(const CellPlan& plan) override {
    if (!watch_.averaged.empty()) ++watch_.rearrangedSince;
    return executor_->rearrange(plan);
  }
  Status average() override {
    if (Status read = executor_->read(watch_.averaged.emplace_back()); !read) return read;
    return executor_->average();
  }
  Status takeMeans() override { return executor_->takeMeans(); }
  Result<CellFacts> facts() override { return executor_->facts(); }
  uint32_t cellCount() const override { return executor_->cellCount(); }
  Status show(const View& view, const AdamStep<float>& adam, std::vector<glm::vec4>& image) override {
    watch_.now += 1e6;  // it takes no time of steps
    return executor_->show(view, adam, image);
  }
  Status read(FoamStorage<float>& foam) override { return executor_->read(foam); }
  Status beginAnew() override { return executor_->beginAnew(); }
  Result<uint64_t> droppedCount() override { return executor_->droppedCount(); }

 private:
  std::unique_ptr<StepExecutor> executor_;
  Watch& watch_;
};

class TimedTraining : public ::testing::Test {
 protected:
  TimedTraining() : state_(fs::path(::testing::TempDir()) / "froth_timed.state.bin") {
    options_.schedule.seconds = 1000;
    options_.schedule.startCells = 300;
    options_.schedule.mostCells = 400;
    options_.detailCount = options_.lobeCount = 2;
    options_.measureTimes = 10;
    options_.whenMeasured = [this](const TrainingMoment& moment) -> Status {
      moments_.push_back(moment);
      return {};
    };
    for (auto* photos : {&gallery_.set.training, &gallery_.set.testing}) {
      for (Photo& photo : *photos) photo.view.nearRatio = 1;  // few cells are large, and none would be seen
    }
  }
  ~TimedTraining() override { fs::remove(state_); }

  Result<TrainResult> train(Watch& watch, const Progress& progress = {}) {
    options_.clock = [&watch] { return watch.now; };
    const auto make = [&watch](FoamStorage<float> foam,
                               std::vector<Photo> photos) -> Result<std::unique_ptr<StepExecutor>> {
      Result<std::unique_ptr<StepExecutor>> cpu = makeCpuExecutor(std::move(foam), std::move(photos));
      return std::unique_ptr<StepExecutor>(std::make_unique<WatchedExecutor>(std::move(*cpu), watch));
    };
    return trainScene(gallery_.capture, gallery_.set, options_, make, progress);
  }

  const fs::path state_;
  test::GalleryCapture gallery_ = test::makeGalleryCapture(24, 16);
  TrainOptions options_;
  std::vector<TrainingMoment> moments_;
};

TEST_F(TimedTraining, EndsAtItsBudgetWithTheWholeScheduleDone) {
  Watch watch;
  const Result<TrainResult> result = train(watch);
  ASSERT_TRUE(result) << result.error().message;
  const double budget = options_.schedule.seconds, seconds = moments_.back().seconds;
  EXPECT_GE(seconds, budget);
  EXPECT_LT(seconds, budget + watch.lastStep);
  EXPECT_EQ(result->stepsDone, watch.plans.size());
  EXPECT_GT(result->foam.cellCount, 375u);  // wanted at the last step that splits cells, 0.69 of the schedule: 384

  const StepPlan& last = watch.plans.back();
  const auto points = static_cast<size_t>(Parameter::kPoints);
  const double correction = std::sqrt(1 - std::pow(kBeta2, last.adam.step));  // beta1's is 1 by now
  EXPECT_NEAR(last.adam.rates[points] / correction, 2e-4, 1e-7);
  EXPECT_NEAR(last.weights.normal, 0.01, 2e-4);
  uint32_t stepsBySize[3] = {};
  for (const StepPlan& plan : watch.plans) ++stepsBySize[plan.halvings];
  EXPECT_EQ(stepsBySize[2], 100u);            // a tenth of the time, a second each
  EXPECT_LT(stepsBySize[0], 1000 * 0.6 / 4);  // full size has three fifths of the time, not of the steps

  ASSERT_EQ(moments_.size(), 10u);
  for (size_t i = 0; i < 10; ++i) EXPECT_NEAR(moments_[i].seconds, budget * double(i + 1) / 10, 6) << i;
}

TEST_F(TimedTraining, GivesTheMeanOfItsLastTenth) {
  Watch watch;
  const Result<TrainResult> result = train(watch);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(watch.rearrangedSince, 0u);
  const auto count = static_cast<double>(watch.averaged.size());
  ASSERT_GE(count, 2);
  // Which the frame of the scene leaves alone.
  constexpr auto kColours = static_cast<size_t>(Parameter::kLobeColours);
  ASSERT_EQ(result->foam.lobeColours.size() * 3, watch.averaged[0].values[kColours].size());
  double fromLast = 0;
  for (size_t i = 0; i < watch.averaged[0].values[kColours].size(); ++i) {
    double mean = 0;
    for (const FoamStorage<float>& foam : watch.averaged) mean += foam.values[kColours][i] / count;
    ASSERT_NEAR(result->foam.lobeColours[i / 3][static_cast<int>(i % 3)], mean, 1e-6 * (1 + std::abs(mean)));
    fromLast = std::max(fromLast, std::abs(mean - watch.averaged.back().values[kColours][i]));
  }
  EXPECT_GT(fromLast, 1e-4);
}

TEST_F(TimedTraining, AfterAStopGivesTheSameBits) {
  Watch wholeWatch;
  const Result<TrainResult> whole = train(wholeWatch);
  ASSERT_TRUE(whole) << whole.error().message;
  options_.state = state_;
  for (const uint64_t stop : {600u, 960u}) {  // steps are averaged from 900 seconds on
    Watch stoppedWatch, resumedWatch;
    options_.isResumed = false;
    const Result<TrainResult> stopped =
        train(stoppedWatch, [stop](std::string_view, uint64_t seconds, uint64_t) { return seconds < stop; });
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, ErrorKind::kCancelled);
    EXPECT_EQ(stoppedWatch.averaged.empty(), stop == 600);
    options_.isResumed = true;
    resumedWatch.now = 7;  // another clock
    const Result<TrainResult> resumed = train(resumedWatch);
    ASSERT_TRUE(resumed) << resumed.error().message;
    EXPECT_EQ(resumed->firstStep, stoppedWatch.plans.size());
    EXPECT_EQ(resumed->stepsDone, whole->stepsDone);
    visitArrays([&](const FoamArray& array, auto values) {
      EXPECT_EQ(whole->foam.*values, resumed->foam.*values) << array.name;
    });
    EXPECT_EQ(whole->testPsnrs, resumed->testPsnrs);
  }

  options_.schedule.seconds = 900;
  Watch watch;
  const Result<TrainResult> other = train(watch);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("seconds 1000"), std::string::npos) << other.error().message;
}

}  // namespace
}  // namespace froth
