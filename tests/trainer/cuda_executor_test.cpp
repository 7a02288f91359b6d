// Executors on one GPU and on two do what the executor on the CPU does. Skipped where there are not so many.
#include "trainer/cuda/multi_gpu_executor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/counter_random.h"
#include "tests/reference/scenes.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/cpu/skin_pairs.h"
#include "trainer/loop/cpu_executor.h"
#include "trainer/loop/drift_tables.h"
#include "trainer/loop/train_scene.h"
#include "trainer/step/running_mean.h"

namespace froth {
namespace {

constexpr uint32_t kCells = 2001, kWidth = 211, kHeight = 133;  // no multiples of a warp and of a tile

class CudaExecutorOf : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!hasCudaDevice()) GTEST_SKIP() << "no GPU";
    foam_ = storeFoam<float>(randomFoam(kCells, 3, 2, 5));
  }

  // Half transparent here and there; a mask on the right.
  static Photo makePhoto(const glm::dvec3& eye, uint32_t scale = 1) {
    Photo photo;
    photo.view = lookAt(eye, {0.1, 0, 0}, scale * kWidth, scale * kHeight, 0.6);
    const CounterRandom random(7, Purpose::kColour);
    for (uint32_t i = 0; i < scale * kWidth * scale * kHeight; ++i) {
      const double alpha = i % 5 == 0 ? random.uniform(4 * i) : 1;
      for (uint32_t c = 0; c < 3; ++c) photo.rgba.push_back(uint8_t(255 * alpha * random.uniform(4 * i + 1 + c)));
      photo.rgba.push_back(uint8_t(255 * alpha));
      photo.counted.push_back(i % (scale * kWidth) < scale * (kWidth - 20));
    }
    return photo;
  }

  StepPlan planOf(uint32_t step, std::vector<uint32_t> photos) { return planOf(drifts_, step, std::move(photos)); }
  StepPlan planOf(DriftTables& drifts, uint32_t step, std::vector<uint32_t> photos) {
    return {std::move(photos), step % 2, drifts.adamAt(step), weightsAt(schedule_, pace_.positionAt(step)), 1e-2f};
  }

  // In the second step cells wait that the first photos show alone, and the third updates them.
  void expectStepsOfTheCpu(StepExecutor& gpu, const std::vector<std::vector<uint32_t>>& photosOfSteps);
  void expectSameBits(const MakeExecutor& make, uint32_t photosPerStep);

  FoamStorage<float> foam_;
  std::vector<Photo> photos_{makePhoto({0.5, 0.4, -3}), makePhoto({-2, 1.2, -2})};
  Schedule schedule_;
  Pace pace_{schedule_};
  Eyes eyes_{{10, 0, 0}, 1};  // units of some 2
  DriftTables drifts_{pace_, eyes_};
};

double relativeDifference(const std::vector<float>& expected, const std::vector<float>& found) {
  double squares = 0, differences = 0;
  for (size_t i = 0; i < expected.size(); ++i) {
    squares += double{expected[i]} * expected[i];
    differences += (double{found[i]} - expected[i]) * (double{found[i]} - expected[i]);
  }
  return std::sqrt(differences / std::max(squares, 1e-60));
}

TEST_F(CudaExecutorOf, FindsThePairsOfTheCpu) {
  CudaStep step;
  ASSERT_TRUE(step.start());
  ASSERT_TRUE(step.upload(foam_));
  ASSERT_TRUE(step.activate(1e-3f));
  CellGraph found;
  std::vector<uint32_t> reverses;
  ASSERT_TRUE(step.downloadPairs(found, reverses));
  const TrainedFoam<float> view = viewStorage(foam_);
  for (uint32_t cell = 0; cell < kCells; ++cell) foam_.balls[cell] = ballOf(view, cell);
  SkinPairs pairs;
  ASSERT_TRUE(pairs.follow(foam_.balls, 1e-3f));
  const CellGraph& expected = pairs.graph();
  ASSERT_GT(expected.neighbours.size(), 5000u);
  EXPECT_LE(found.neighbours.size(), expected.neighbours.size() * 1.001);  // some touch within rounding
  for (uint32_t cell = 0; cell < kCells; ++cell) {
    const auto begin = found.neighbours.begin() + found.offsets[cell],
               end = begin + found.offsets[cell + 1] - found.offsets[cell];
    ASSERT_TRUE(std::is_sorted(begin, end)) << cell;
    for (uint32_t e = expected.offsets[cell]; e < expected.offsets[cell + 1]; ++e) {
      ASSERT_TRUE(std::binary_search(begin, end, expected.neighbours[e])) << cell;
    }
    for (uint32_t e = found.offsets[cell]; e < found.offsets[cell + 1]; ++e) {
      ASSERT_EQ(found.neighbours[reverses[e]], cell);
      ASSERT_GE(reverses[e], found.offsets[found.neighbours[e]]);
      ASSERT_LT(reverses[e], found.offsets[found.neighbours[e] + 1]);
    }
  }
}

// The first step has the gradients in its moments. The CPU begins each step from the GPU's foam: Adam's first steps
// move a number by its whole rate, even where its gradient is almost 0. So foams that differ by rounding would drift
// apart, and rays that graze a cell would show it.
void CudaExecutorOf::expectStepsOfTheCpu(StepExecutor& gpu, const std::vector<std::vector<uint32_t>>& photosOfSteps) {
  for (uint32_t step = 0; step < photosOfSteps.size(); ++step) {
    FoamStorage<float> before;
    ASSERT_TRUE(gpu.read(before));
    CpuExecutor cpu(before, photos_);
    const StepPlan plan = planOf(step, photosOfSteps[step]);
    ASSERT_TRUE(cpu.run(plan));
    const Status ran = gpu.run(plan);
    ASSERT_TRUE(ran) << ran.error().message;
    FoamStorage<float> expected, found;
    ASSERT_TRUE(cpu.read(expected));
    ASSERT_TRUE(gpu.read(found));
    for (size_t i = 0; i < kParameterCount; ++i) {
      EXPECT_LE(relativeDifference(expected.firstMoments[i], found.firstMoments[i]), 0.01)
          << kParameterKeys[i] << " in step " << step;
    }
    uint32_t shownByOne = 0;  // a ray may graze a cell or miss it
    for (uint32_t cell = 0; cell < kCells; ++cell) shownByOne += expected.lastSteps[cell] != found.lastSteps[cell];
    EXPECT_LE(shownByOne, kCells / 200);
    EXPECT_LE(relativeDifference(expected.errors, found.errors), 1e-3);
    EXPECT_LE(relativeDifference(expected.contributions, found.contributions), 1e-3);
  }
  const Result<uint64_t> dropped = gpu.droppedCount();
  ASSERT_TRUE(dropped);
  EXPECT_EQ(*dropped, 0u);
}

TEST_F(CudaExecutorOf, TakesTheStepsOfTheCpu) {
  Result<std::unique_ptr<StepExecutor>> gpu = CudaExecutor::make(foam_, photos_);
  ASSERT_TRUE(gpu) << gpu.error().message;
  expectStepsOfTheCpu(**gpu, {{0}, {1}, {0}});
}

TEST_F(CudaExecutorOf, TakesStepsOfSeveralPhotosOfTheCpu) {
  Result<std::unique_ptr<StepExecutor>> gpu = CudaExecutor::make(foam_, photos_);
  ASSERT_TRUE(gpu) << gpu.error().message;
  expectStepsOfTheCpu(**gpu, {{0}, {1, 0}, {0, 0, 1}});
}

TEST_F(CudaExecutorOf, RearrangesAsTheCpu) {
  Result<std::unique_ptr<StepExecutor>> gpu = CudaExecutor::make(foam_, photos_);
  ASSERT_TRUE(gpu) << gpu.error().message;
  ASSERT_TRUE((*gpu)->run(planOf(0, {0})));
  FoamStorage<float> before, after;
  ASSERT_TRUE((*gpu)->read(before));
  const Result<CellFacts> facts = (*gpu)->facts();
  ASSERT_TRUE(facts);
  CellPlan plan = planCells(*facts, kCells + 500, {}, 3, 99);
  for (size_t i = 0; i < plan.changes.size(); i += 3) plan.changes[i].radiusFactor = 0.9f;
  ASSERT_TRUE((*gpu)->rearrange(plan));
  ASSERT_TRUE((*gpu)->read(after));
  const FoamStorage<float> expected = rearrange(before, plan);
  EXPECT_EQ(after.shape.cellCount, plan.sources.size());
  for (size_t i = 0; i < kParameterCount; ++i) {
    const auto parameter = static_cast<Parameter>(i);
    const bool isRounded = parameter == Parameter::kRadii || parameter == Parameter::kDensity;
    EXPECT_LE(relativeDifference(expected.values[i], after.values[i]), isRounded ? 1e-5 : 0.0) << kParameterKeys[i];
  }
  EXPECT_EQ(after.firstMoments, expected.firstMoments);
  EXPECT_EQ(after.secondMoments, expected.secondMoments);
  EXPECT_EQ(after.lastSteps, expected.lastSteps);
  EXPECT_EQ(after.contributions, expected.contributions);
  EXPECT_EQ(after.errors, expected.errors);
  EXPECT_TRUE((*gpu)->run(planOf(1, {1})));
}

// Cells come and go, and the third run goes on from the half of another.
void CudaExecutorOf::expectSameBits(const MakeExecutor& make, uint32_t photosPerStep) {
  FoamStorage<float> first, halfway, found;
  for (uint32_t run = 0; run < 3; ++run) {
    Result<std::unique_ptr<StepExecutor>> gpu = make(run == 2 ? halfway : foam_, photos_);
    ASSERT_TRUE(gpu) << gpu.error().message;
    DriftTables drifts(pace_, eyes_);  // they never go back
    for (uint32_t step = run == 2 ? 20 : 0; step < 40; ++step) {
      std::vector<uint32_t> photos{step % 2, step / 2 % 2};
      photos.resize(photosPerStep);
      const Status ran = (*gpu)->run(planOf(drifts, step, photos));
      ASSERT_TRUE(ran) << ran.error().message;
      if (step % 15 == 14) {
        const Result<CellFacts> facts = (*gpu)->facts();
        ASSERT_TRUE(facts);
        ASSERT_TRUE((*gpu)->rearrange(planCells(*facts, (*gpu)->cellCount() + 300, {}, 3, step)));
      }
      if (step != 19) continue;
      ASSERT_TRUE((*gpu)->beginAnew());
      ASSERT_TRUE((*gpu)->read(halfway));
    }
    ASSERT_TRUE((*gpu)->read(found));
    if (run == 0) first = found;
    EXPECT_EQ(found.values, first.values) << run;
    EXPECT_EQ(found.firstMoments, first.firstMoments) << run;
    EXPECT_EQ(found.secondMoments, first.secondMoments) << run;
    EXPECT_EQ(found.contributions, first.contributions) << run;
    EXPECT_EQ(found.errors, first.errors) << run;
  }
  EXPECT_NE(first.values, foam_.values);
}

TEST_F(CudaExecutorOf, GivesTheSameBitsWhereItIsDeterministic) {
  const MakeExecutor make = [](const FoamStorage<float>& foam, std::vector<Photo> photos) {
    return CudaExecutor::make(foam, std::move(photos), true);
  };
  expectSameBits(make, 1);
  expectSameBits(make, 2);
}

TEST_F(CudaExecutorOf, TakesTheStepsOfTheCpuWhereItIsDeterministic) {
  Result<std::unique_ptr<StepExecutor>> gpu = CudaExecutor::make(foam_, photos_, true);
  ASSERT_TRUE(gpu) << gpu.error().message;
  expectStepsOfTheCpu(**gpu, {{0}, {1, 0}, {0, 0, 1}});
}

// Nothing is multiplied, so the GPU rounds as the CPU does.
TEST_F(CudaExecutorOf, KeepsTheMeanOfItsValues) {
  Result<std::unique_ptr<StepExecutor>> gpu = CudaExecutor::make(foam_, photos_);
  ASSERT_TRUE(gpu) << gpu.error().message;
  FoamStorage<float> found;
  FoamStorage<float>::Tensors expected;
  for (uint32_t step = 0; step < 6; ++step) {
    ASSERT_TRUE((*gpu)->run(planOf(1000 + step, {step % 2})));
    ASSERT_TRUE((*gpu)->average());
    ASSERT_TRUE((*gpu)->read(found));
    ASSERT_EQ(found.averagedSteps, step + 1);
    for (size_t t = 0; t < kParameterCount; ++t) {
      expected[t].resize(found.values[t].size());
      for (size_t i = 0; i < expected[t].size(); ++i) {
        expected[t][i] = foldIntoMean(expected[t][i], found.values[t][i], step + 1);
      }
      ASSERT_EQ(found.meanValues[t], expected[t]) << kParameterKeys[t] << " in step " << step;
    }
    if (step == 2) gpu = CudaExecutor::make(found, photos_);  // as a run that goes on
    ASSERT_TRUE(gpu) << gpu.error().message;
  }
  EXPECT_NE(found.values, expected);
  ASSERT_TRUE((*gpu)->takeMeans());
  std::vector<glm::vec4> shown, other;
  ASSERT_TRUE((*gpu)->show(photos_[0].view, drifts_.adamAt(1010), shown));
  ASSERT_TRUE((*gpu)->read(found));
  EXPECT_EQ(found.values, expected);
  EXPECT_EQ(found.averagedSteps, 0u);
  std::fill(found.lastSteps.begin(), found.lastSteps.end(), 1010);  // no cell waits
  CpuExecutor cpu(found, photos_);
  ASSERT_TRUE(cpu.show(photos_[0].view, drifts_.adamAt(1010), other));
  ASSERT_EQ(shown.size(), other.size());
  double squares = 0;
  for (size_t i = 0; i < shown.size(); ++i) squares += glm::dot(shown[i] - other[i], shown[i] - other[i]);
  EXPECT_LE(std::sqrt(squares / (4.0 * double(shown.size()))), 2e-5);  // kImageTolerance of cuda_step_test.cpp
}

TEST(GpuGroup, NeedsNcclOrSaysWhatToInstall) {
  const Status there = GpuGroup::check();
  if (!there) {
    EXPECT_NE(there.error().message.find("install"), std::string::npos) << there.error().message;
  }
}

class TwoGpus : public CudaExecutorOf {
 protected:
  void SetUp() override {
    if (cudaDeviceCount() < 2) GTEST_SKIP() << "fewer than two GPUs";
    CudaExecutorOf::SetUp();
  }

  MultiGpuExecutor& makeBoth() {
    Result<std::unique_ptr<StepExecutor>> made = MultiGpuExecutor::make(2, foam_, photos_);
    EXPECT_TRUE(made) << made.error().message;
    owned_ = std::move(*made);
    return static_cast<MultiGpuExecutor&>(*owned_);
  }

  static void expectSameFoams(MultiGpuExecutor& both) {
    FoamStorage<float> first, second;
    ASSERT_EQ(cudaSetDevice(0), cudaSuccess);
    ASSERT_TRUE(both.gpu(0).read(first));
    ASSERT_EQ(cudaSetDevice(1), cudaSuccess);
    ASSERT_TRUE(both.gpu(1).read(second));
    ASSERT_EQ(first.shape.cellCount, second.shape.cellCount);
    for (size_t i = 0; i < kParameterCount; ++i) {
      EXPECT_EQ(first.values[i], second.values[i]) << kParameterKeys[i];
      EXPECT_EQ(first.firstMoments[i], second.firstMoments[i]) << kParameterKeys[i];
      EXPECT_EQ(first.secondMoments[i], second.secondMoments[i]) << kParameterKeys[i];
    }
    EXPECT_EQ(first.lastSteps, second.lastSteps);
    EXPECT_EQ(first.contributions, second.contributions);
    EXPECT_EQ(first.errors, second.errors);
    EXPECT_EQ(first.averagedSteps, second.averagedSteps);
    EXPECT_EQ(first.meanValues, second.meanValues);
  }

  std::unique_ptr<StepExecutor> owned_;
};

TEST_F(TwoGpus, TakeTheStepsOfTheCpu) { expectStepsOfTheCpu(makeBoth(), {{0, 1}, {1, 1}, {1, 0, 0, 1}}); }

TEST_F(TwoGpus, GiveTheSameBitsWhereTheyAreDeterministic) {
  const MakeExecutor make = [](const FoamStorage<float>& foam, std::vector<Photo> photos) {
    return MultiGpuExecutor::make(2, foam, std::move(photos), true);
  };
  expectSameBits(make, 2);
}

TEST_F(TwoGpus, KeepTheSameFoams) {
  MultiGpuExecutor& both = makeBoth();
  for (uint32_t step = 0; step < 40; ++step) {
    ASSERT_TRUE(both.run(planOf(step, {step % 2, step / 2 % 2})));
    std::vector<glm::vec4> image;
    if (step == 10) {
      ASSERT_TRUE(both.show(photos_[0].view, drifts_.adamAt(step + 1), image));
    }
    if (step >= 30) {
      ASSERT_TRUE(both.average());
    }
    if (step % 15 != 14) continue;
    expectSameFoams(both);
    const Result<CellFacts> facts = both.facts();
    ASSERT_TRUE(facts);
    ASSERT_TRUE(both.rearrange(planCells(*facts, both.cellCount() + 300, {}, 3, step)));
  }
  expectSameFoams(both);
  ASSERT_TRUE(both.takeMeans());
  expectSameFoams(both);
}

// The lists of the first photo alone do not fit into the first guess.
TEST_F(TwoGpus, TakeAStepAgainThatDidNotFitOnOne) {
  photos_[0] = makePhoto({0.5, 0.4, -3}, 8);
  MultiGpuExecutor& both = makeBoth();
  ASSERT_EQ(cudaSetDevice(0), cudaSuccess);  // of whatever `one` does
  Result<std::unique_ptr<StepExecutor>> one = CudaExecutor::make(foam_, photos_);
  ASSERT_TRUE(one) << one.error().message;
  for (uint32_t step = 0; step < 2; ++step) {
    StepPlan plan = planOf(step, {step, 1 - step});
    plan.halvings = 0;
    ASSERT_TRUE(both.run(plan));
    ASSERT_EQ(cudaSetDevice(0), cudaSuccess);
    ASSERT_TRUE((*one)->run(plan));
    expectSameFoams(both);
    FoamStorage<float> expected, found;
    ASSERT_TRUE(both.read(found));
    ASSERT_TRUE((*one)->read(expected));
    for (size_t i = 0; i < kParameterCount; ++i) {
      EXPECT_LE(relativeDifference(expected.firstMoments[i], found.firstMoments[i]), 0.01) << kParameterKeys[i];
    }
  }
  EXPECT_GT(both.gpu(0).step().counters().tileEntries + both.gpu(1).step().counters().tileEntries, 1u << 20);
}

TEST_F(TwoGpus, RefuseStepsThatTheyDoNotShareEvenly) {
  const Status ran = makeBoth().run(planOf(0, {0, 1, 0}));
  ASSERT_FALSE(ran);
  EXPECT_EQ(ran.error().kind, ErrorKind::kUsage);
  EXPECT_NE(ran.error().message.find("--gpus 3"), std::string::npos) << ran.error().message;
}

}  // namespace
}  // namespace froth
