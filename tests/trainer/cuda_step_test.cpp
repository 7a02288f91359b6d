// The step on a GPU does what the step on the CPU does. Skipped where there is no GPU.
#include "trainer/cuda/cuda_step.h"

#include <gtest/gtest.h>

#include "tests/reference/scenes.h"
#include "tests/trainer/cuda_comparison.h"
#include "trainer/cpu/cpu_step.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/cpu/view_exchange.h"
#include "trainer/cuda/cuda_executor.h"
#include "trainer/loop/drift_tables.h"

namespace froth {
namespace {

struct Case {
  const char* name;
  uint32_t cellCount, detailCount, lobeCount;
  glm::dvec3 eye;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class CudaStepOf : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!hasCudaDevice()) GTEST_SKIP() << "no GPU";
  }
};

// No multiples of a tile.
constexpr uint32_t kWidth = 211, kHeight = 133;

StepCase makeCase(const glm::dvec3& eye) {
  StepCase stepCase;
  stepCase.view = trainingView<float>(lookAt(eye, {0.1, 0, 0}, kWidth, kHeight, 0.6));
  stepCase.view.nearRatio = 1.5f;
  stepCase.view.nearDepth = 0.1f;
  stepCase.settings.perPixel = 1.0f / (kWidth * kHeight);
  stepCase.settings.normalWeight = 0.1f * stepCase.settings.perPixel;
  stepCase.overlapWeight = 1e-4f;
  std::fill(std::begin(stepCase.adam.rates), std::end(stepCase.adam.rates), 1e-3f);
  return stepCase;
}

// Rays within rounding of the edge between two branches take either, so some gradients differ by a whole ray; all
// others differ by the rounding of sums.
constexpr double kImageTolerance = 2e-5, kGradientTolerance = 5e-3, kPartFarOff = 5e-3, kRoundedSum = 1e-6;
constexpr double kValueTolerance = 5e-2;  // a parameter that was hardly shown moves by its rate, whichever way

TEST_P(CudaStepOf, EqualsTheCpuUpToRounding) {
  const Case& c = GetParam();
  const FoamStorage<float> foam = storeFoam<float>(randomFoam(c.cellCount, c.detailCount, c.lobeCount, 5));
  const Result<StepComparison> found = compareStep(foam, makeCase(c.eye));
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_GT(found->seenOnCpu, c.cellCount / 10);
  EXPECT_EQ(found->seenOnGpu, found->seenOnCpu);
  EXPECT_LE(found->shownByOne, 1 + c.cellCount / 200);  // a ray may graze a cell or miss it
  EXPECT_LE(found->image.rootMeanSquare, kImageTolerance);
  for (size_t i = 0; i < kParameterCount; ++i) {
    if (c.detailCount == 1 && i == static_cast<size_t>(Parameter::kDetailSites)) {
      // A single site has all the weight wherever it is: its gradient is 0, and rounding on both sides.
      const double heights = found->gradients[static_cast<size_t>(Parameter::kDetailHeights)].scale;
      EXPECT_LE(found->gradients[i].rootMeanSquare * found->gradients[i].scale, kRoundedSum * heights);
      continue;
    }
    EXPECT_LE(found->gradients[i].rootMeanSquare, kGradientTolerance) << kParameterKeys[i];
    EXPECT_LE(found->gradients[i].partFarOff, kPartFarOff) << kParameterKeys[i];
  }
  EXPECT_LE(found->contributions.rootMeanSquare, kGradientTolerance);
  EXPECT_LE(found->errors.rootMeanSquare, kGradientTolerance);
}

// Far away the same foam has small balls, whose grazing rays are rounding on both sides.
TEST(CudaStep, OfSmallFarBallsIsOffByRoundingAlone) {
  if (!hasCudaDevice()) GTEST_SKIP() << "no GPU";
  StepCase stepCase = makeCase({10, 8, -60});
  stepCase.view.fx *= 20;
  stepCase.view.fy *= 20;
  const Result<StepComparison> found = compareStep(storeFoam<float>(randomFoam(2000, 8, 8, 5)), stepCase);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_GT(found->seenOnCpu, 200u);
  for (size_t i = 0; i < kParameterCount; ++i) {
    EXPECT_LE(found->gradients[i].rootMeanSquare, kGradientTolerance + 3 * found->roundings[i].rootMeanSquare)
        << kParameterKeys[i];
  }
}

// Steps from several sides leave moments and cells that wait; a step long after them reads and updates what they left.
// K and M are such that a detail site has lanes without a lobe, and the last round fewer sites than others.
class CudaStepAfterAWait : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!hasCudaDevice()) GTEST_SKIP() << "no GPU";
  }

  // step: of kSteps that came before.
  StepCase caseAt(const glm::dvec3& eye, uint32_t step) {
    StepCase stepCase = makeCase(eye);
    stepCase.adam = drifts_.adamAt(kFirst + step);
    return stepCase;
  }

  static constexpr uint32_t kFirst = 1000, kSteps = 6, kWaited = 30;  // rates are past their warm-up
  Schedule schedule_;
  Pace pace_{schedule_};
  DriftTables drifts_{pace_, {{10, 0, 0}, 1}};  // seen from so far that lengths count in larger units
};

TEST_P(CudaStepAfterAWait, EqualsTheCpuUpToRounding) {
  const Case& c = GetParam();
  Foam start = randomFoam(c.cellCount, c.detailCount, c.lobeCount, 5);
  for (float& density : start.densities) density *= 60;  // no step makes a cell vanish
  FoamStorage<float> foam = storeFoam<float>(start);
  {
    CpuStep<float> step(foam);
    for (uint32_t i = 0; i < kSteps; ++i) {
      const StepCase stepCase = caseAt(i % 2 == 0 ? c.eye : -c.eye, i);
      step.activate(stepCase.leastSkin);
      (void)step.render(stepCase.view, stepCase.settings, stepCase.adam);
      step.differentiate(plainGradients(kWidth, kHeight), plainWanted(size_t{kWidth} * kHeight));
      step.update(stepCase.adam, stepCase.overlapWeight);
    }
  }
  const Result<StepComparison> found = compareStep(foam, caseAt(c.eye, kSteps + kWaited));
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_LE(found->shownByOne, 1 + c.cellCount / 200);
  EXPECT_LE(found->image.rootMeanSquare, kImageTolerance);
  for (size_t i = 0; i < kParameterCount; ++i) {
    EXPECT_LE(found->gradients[i].rootMeanSquare, kGradientTolerance) << kParameterKeys[i];
    EXPECT_LE(found->values[i].rootMeanSquare, kValueTolerance) << kParameterKeys[i];
    EXPECT_LE(found->values[i].partFarOff, kPartFarOff) << kParameterKeys[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Foams, CudaStepAfterAWait,
                         ::testing::Values(Case{"EightOfEight", 2000, 8, 8, {0.5, 0.4, -3}},
                                           Case{"ElevenOfFive", 500, 11, 5, {0.5, 0.4, -3}},
                                           Case{"FourOfThirtyTwo", 300, 4, 32, {-3, 4, 1}}),
                         [](const auto& tested) { return tested.param.name; });

INSTANTIATE_TEST_SUITE_P(Foams, CudaStepOf,
                         ::testing::Values(Case{"ThreeOfTwo", 300, 3, 2, {0.5, 0.4, -3}},
                                           Case{"EightOfEight", 2000, 8, 8, {0.5, 0.4, -3}},
                                           Case{"EyeInside", 300, 3, 2, {0.3, 0.2, 0.25}},
                                           Case{"OneOfOne", 300, 1, 1, {-3, 4, 1}},
                                           Case{"ThirtyTwo", 60, 32, 3, {0.5, 0.4, -3}}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace froth
