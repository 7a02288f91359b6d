// The step on the CPU: it shows what the reference renderer shows, on any number of threads, and survives poison.
#include "trainer/cpu/cpu_step.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "tests/reference/scenes.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/cpu/view_exchange.h"

namespace froth {
namespace {

constexpr uint32_t kWidth = 61, kHeight = 43;  // no multiples of a tile

std::vector<glm::vec4> gradientsFor(const std::vector<glm::vec4>& shown) {
  std::vector<glm::vec4> gradients(shown.size());
  for (size_t i = 0; i < shown.size(); ++i) {
    gradients[i] = (shown[i] - glm::vec4(0.3f, 0.5f, 0.7f, 0.2f)) / float(shown.size());
  }
  return gradients;
}

// A step with the rate of the first step of training.
AdamStep<float> firstAdam() {
  AdamStep<float> adam{};
  std::fill(std::begin(adam.rates), std::end(adam.rates), 1e-3f);
  return adam;
}

void takeStep(CpuStep<float>& step, const TrainingView<float>& view) {
  PixelSettings<float> settings;
  settings.normalWeight = 1e-4f;
  settings.perPixel = 1.0f / (kWidth * kHeight);
  step.activate(1e-3f);
  const std::vector<glm::vec4> shown = step.render(view, settings, firstAdam());
  step.differentiate(gradientsFor(shown), std::vector<glm::vec4>(shown.size()));
  step.update(firstAdam(), 1e-4f);
}

class CpuStepOf : public ::testing::TestWithParam<glm::dvec3> {};

TEST_P(CpuStepOf, ShowsWhatTheReferenceShows) {
  const Foam foam = activateFoam(storeFoam<float>(randomFoam(60, 3, 2, 5)));
  FoamStorage<double> storage = storeFoam<double>(foam);
  const View view = lookAt(GetParam(), {0.1, 0, 0}, kWidth, kHeight, 0.6);
  ReferenceOptions options = plainOptions();
  options.nearRatio = 1.5;
  options.nearDepth = 0.7;
  const RenderedImages images = renderFoam(foam, view, options);

  CpuStep<double> step(storage);
  TrainingView<double> training = trainingView<double>(view);
  training.nearRatio = options.nearRatio;
  training.nearDepth = options.nearDepth;
  PixelSettings<double> settings;
  settings.cutoff = 0;
  step.activate(0.01f);
  AdamStep<double> adam{};
  const std::vector<glm::dvec4>& shown = step.render(training, settings, adam);
  // Raw radii and densities are floats, so a foam that went through them differs by some 1e-6 of each.
  constexpr double kTolerance = 2e-5;
  for (uint32_t y = 0; y < kHeight; ++y) {
    for (uint32_t x = 0; x < kWidth; ++x) {
      const glm::dvec4& found = shown[size_t{y} * kWidth + x];
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(found[c], images.colour.pixel(x, y)[c], kTolerance) << x << " " << y;
      ASSERT_NEAR(1 - found.w, *images.alpha.pixel(x, y), kTolerance) << x << " " << y;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Eyes, CpuStepOf,
                         ::testing::Values(glm::dvec3(0.5, 0.4, -3), glm::dvec3(0.3, 0.2, 0.25),
                                           glm::dvec3(-30, 4, 9)));

TEST(CpuStep, GivesTheSameBitsOnAnyNumberOfThreads) {
  const TrainingView<float> view = trainingView<float>(lookAt({0.5, 0.4, -3}, {0, 0, 0}, kWidth, kHeight, 0.5));
  FoamStorage<float> one = storeFoam<float>(randomFoam(300, 3, 2, 6)), many = one;
  {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    CpuStep<float> step(one);
    for (int i = 0; i < 3; ++i) takeStep(step, view);
  }
  CpuStep<float> step(many);
  for (int i = 0; i < 3; ++i) takeStep(step, view);
  for (size_t t = 0; t < kParameterCount; ++t) {
    EXPECT_EQ(one.values[t], many.values[t]) << kParameterKeys[t];
    EXPECT_EQ(one.secondMoments[t], many.secondMoments[t]) << kParameterKeys[t];
  }
  EXPECT_EQ(one.errors, many.errors);
}

TEST(CpuStep, NeedsNoMomentsToShowAndDifferentiate) {
  const TrainingView<float> view = trainingView<float>(lookAt({0.5, 0.4, -3}, {0, 0, 0}, kWidth, kHeight, 0.5));
  PixelSettings<float> settings;
  settings.perPixel = 1.0f / (kWidth * kHeight);
  std::vector<glm::vec4> shown[2];
  std::vector<float> densities[2];
  for (const AdamMoments moments : {AdamMoments::kKept, AdamMoments::kNone}) {
    const auto own = static_cast<size_t>(moments);
    FoamStorage<float> foam = storeFoam<float>(randomFoam(300, 3, 2, 6), moments);
    EXPECT_EQ(foam.firstMoments[0].empty(), moments == AdamMoments::kNone);
    CpuStep<float> step(foam);
    step.activate(1e-3f);
    shown[own] = step.render(view, settings, firstAdam());
    step.differentiate(gradientsFor(shown[own]), std::vector<glm::vec4>(shown[own].size()));
    for (uint32_t rank = 0; rank < step.seen().count; ++rank) densities[own].push_back(step.sums().cells[rank].density);
  }
  EXPECT_EQ(shown[0], shown[1]);
  EXPECT_EQ(densities[0], densities[1]);
  EXPECT_TRUE(std::ranges::any_of(densities[0], [](float density) { return density != 0; }));
}

using SeenBall = std::array<float, 4>;

// The balls that a view sees of cells in this order. One of them becomes infinite.
std::vector<SeenBall> seenOf(Foam foam, const std::vector<uint32_t>& order, const View& view) {
  const Foam given = foam;
  for (uint32_t i = 0; i < order.size(); ++i) {
    foam.sites[i] = given.sites[order[i]];
    foam.radii[i] = given.radii[order[i]];
  }
  FoamStorage<float> storage = storeFoam<float>(foam);
  storage.values[size_t(Parameter::kRadii)][foam.cellCount / 2] = std::numeric_limits<float>::infinity();
  CpuStep<float> step(storage);
  step.activate(1e-3f);
  step.render(trainingView<float>(view), {}, firstAdam());
  std::vector<SeenBall> balls;
  for (uint32_t rank = 0; rank < step.seen().count; ++rank) {
    const glm::vec4& ball = storage.balls[step.seen().cells[rank].cell];
    balls.push_back({ball.x, ball.y, ball.z, ball.w});
  }
  std::ranges::sort(balls);
  return balls;
}

// Cells that lie beside each other are culled together where they follow each other.
TEST(CpuStep, SeesTheSameCellsInAnyOrder) {
  Foam foam = randomFoam(3000, 1, 1, 6);
  for (glm::vec3& site : foam.sites) site *= 5.0f;
  for (float& radius : foam.radii) radius *= 0.3f;
  std::vector<uint32_t> mixed(foam.cellCount);
  std::iota(mixed.begin(), mixed.end(), 0u);
  std::vector<uint32_t> sorted = mixed;
  const auto columnOf = [&](uint32_t cell) {
    const glm::vec3& site = foam.sites[cell];
    return std::tuple(std::floor(site.x / 2.5f), std::floor(site.y / 2.5f), site.z);
  };
  std::ranges::stable_sort(sorted, {}, columnOf);
  // The infinite ball takes the place of the same one.
  std::swap(*std::ranges::find(sorted, mixed[foam.cellCount / 2]), sorted[foam.cellCount / 2]);
  size_t seenCount = 0;
  for (int i = 0; i < 40; ++i) {
    const glm::dvec3 target(4 * std::sin(i), 4 * std::sin(1.7 * i), 4 * std::cos(2.3 * i));
    const View view = lookAt({0.5, 0.4, -6}, target, kWidth, kHeight, 0.05);
    const std::vector<SeenBall> seen = seenOf(foam, sorted, view);
    EXPECT_EQ(seen, seenOf(foam, mixed, view)) << i;
    seenCount += seen.size();
  }
  EXPECT_GT(seenCount, 400u);
}

TEST(CpuStep, PreparesNoCellsThatNoRayComesTo) {
  Foam foam = randomFoam(3000, 1, 1, 5);
  for (float& density : foam.densities) density *= 100;
  FoamStorage<float> storage = storeFoam<float>(foam);
  CpuStep<float> step(storage);
  step.activate(0);
  step.render(trainingView<float>(lookAt({0.5, 0.4, -6}, {0, 0, 0}, kWidth, kHeight, 0.3)), {}, firstAdam());
  const SeenCells<float> seen = step.seen();
  const auto prepared =
      std::count_if(seen.cells, seen.cells + seen.count, [](const auto& cell) { return cell.radius > 0; });
  EXPECT_GT(seen.count, 1000u);
  EXPECT_GT(prepared, 100);
  EXPECT_LT(prepared, 0.5 * seen.count);
}

TEST(CpuStep, DropsAndCountsWhatIsNoFiniteNumber) {
  const TrainingView<float> view = trainingView<float>(lookAt({0.5, 0.4, -3}, {0, 0, 0}, kWidth, kHeight, 0.5));
  FoamStorage<float> foam = storeFoam<float>(randomFoam(60, 3, 2, 6));
  const uint32_t poisoned = 7;
  foam.values[size_t(Parameter::kOrientations)][4 * poisoned] = std::numeric_limits<float>::quiet_NaN();
  foam.values[size_t(Parameter::kLobeAxes)][0] = 0;  // |a| = 0, of cell 0
  foam.values[size_t(Parameter::kLobeAxes)][1] = foam.values[size_t(Parameter::kLobeAxes)][2] = 0;
  for (int c = 0; c < 3; ++c) {  // cells 1 and 2 coincide
    foam.values[size_t(Parameter::kPoints)][6 + c] = foam.values[size_t(Parameter::kPoints)][3 + c];
  }
  CpuStep<float> step(foam);
  PixelSettings<float> settings;
  settings.perPixel = 1.0f / (kWidth * kHeight);
  step.activate(1e-3f);
  std::vector<glm::vec4> gradients = gradientsFor(step.render(view, settings, firstAdam()));
  for (const glm::vec4& gradient : gradients) ASSERT_TRUE(std::isfinite(glm::dot(gradient, gradient)));
  gradients[kHeight / 2 * kWidth + kWidth / 2].x = std::numeric_limits<float>::infinity();
  step.differentiate(gradients, std::vector<glm::vec4>(gradients.size()));
  step.update(firstAdam(), 1e-4f);
  EXPECT_GT(step.droppedCount(), 0u);
  for (size_t t = 0; t < kParameterCount; ++t) {
    const uint32_t width = widthOf(static_cast<Parameter>(t), foam.shape);
    for (size_t i = 0; i < foam.values[t].size(); ++i) {
      if (i / width == poisoned) continue;
      ASSERT_TRUE(std::isfinite(foam.values[t][i])) << kParameterKeys[t] << " " << i;
    }
  }
}

}  // namespace
}  // namespace froth
