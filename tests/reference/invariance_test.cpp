// What must not change an image, and what must stop it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <limits>
#include <random>

#include "reference/image/metrics.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

class Invariance : public ::testing::TestWithParam<Precision> {
 protected:
  Invariance() : foam_(randomFoam(300, 3, 2, 11)), view_(lookAt({0.25, -0.5, -2.5}, {0, 0, 0}, 64, 48, 0.6)) {
    options_ = plainOptions(GetParam());
    options_.nearRatio = 4;
    options_.nearDepth = 1.6;
  }
  Foam foam_;
  View view_;
  ReferenceOptions options_;
};

TEST_P(Invariance, TheOrderOfCellsInTheFoamDoesNotMatter) {
  std::vector<uint32_t> order(foam_.cellCount);
  for (uint32_t i = 0; i < foam_.cellCount; ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937_64(3));
  expectSameImages(renderFoam(foam_, view_, options_), renderFoam(permuteFoam(foam_, order), view_, options_));
}

TEST_P(Invariance, TheNumberOfThreadsDoesNotMatter) {
  const RenderedImages many = renderFoam(foam_, view_, options_);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  expectSameImages(many, renderFoam(foam_, view_, options_));
}

TEST_P(Invariance, AMillionUnitsFromTheOriginTheImageIsTheSame) {
  Foam moved = foam_;
  for (glm::vec3& site : moved.sites) site += glm::vec3(1e6f, -1e6f, 0.5e6f);
  for (uint32_t i = 0; i < foam_.cellCount; ++i) {
    ASSERT_EQ(glm::dvec3(moved.sites[i]) - glm::dvec3(1e6, -1e6, 0.5e6), glm::dvec3(foam_.sites[i]));
  }
  View movedView = view_;
  movedView.worldFromCamera[3] += 1e6;
  movedView.worldFromCamera[7] -= 1e6;
  movedView.worldFromCamera[11] += 0.5e6;
  expectSameImages(renderFoam(foam_, view_, options_), renderFoam(moved, movedView, options_));
}

// Goldens are checked on parts of an image, which are views with a shifted principal point.
TEST_P(Invariance, APartOfTheViewIsThatPartOfTheImage) {
  const RenderedImages whole = renderFoam(foam_, view_, options_);
  View part = view_;
  part.width = 20;
  part.height = 10;
  part.cx -= 24;
  part.cy -= 16;
  const RenderedImages cut = renderFoam(foam_, part, options_);
  for (uint32_t y = 0; y < 10; ++y) {
    for (uint32_t x = 0; x < 20; ++x) ASSERT_EQ(*cut.alpha.pixel(x, y), *whole.alpha.pixel(x + 24, y + 16));
  }
}

TEST_P(Invariance, ASmallCutoffChangesAnImageByNoMoreThanItself) {
  const RenderedImages whole = renderFoam(foam_, view_, options_);
  options_.cutoff = 0.01;
  const RenderedImages cut = renderFoam(foam_, view_, options_);
  const double error = compareImages(whole.alpha, cut.alpha)->maxError;
  EXPECT_GT(error, 0);
  EXPECT_LE(error, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Precisions, Invariance, ::testing::Values(Precision::kFloat, Precision::kDouble),
                         [](const auto& test) { return test.param == Precision::kFloat ? "Float" : "Double"; });

TEST(Rendering, ReportsRowsAndStopsOnRequest) {
  const Foam foam = randomFoam(30, 1, 1, 1);
  const View view = lookAt({0, 0, -3}, {0, 0, 0}, 8, 400, 0.6);
  uint64_t calls = 0, most = 0;
  const Result<RenderedImages> images =
      ReferenceRenderer(foam).render(view, plainOptions(), [&](std::string_view, uint64_t done, uint64_t total) {
        EXPECT_EQ(total, 400u);
        ++calls;
        most = std::max(most, done);
        return true;
      });
  EXPECT_TRUE(images);
  EXPECT_EQ(calls, 100u);
  EXPECT_EQ(most, 400u);

  const Result<RenderedImages> stopped =
      ReferenceRenderer(foam).render(view, plainOptions(), [](std::string_view, uint64_t, uint64_t) { return false; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::kCancelled);
}

TEST(Rendering, RefusesViewsWithoutPixelsAndImpossibleQuantiles) {
  const Foam foam = randomFoam(3, 1, 1, 1);
  const ReferenceRenderer renderer(foam);
  View view = lookAt({0, 0, -3}, {0, 0, 0}, 8, 8, 0.6);
  view.width = 0;
  EXPECT_EQ(renderer.render(view, plainOptions()).error().kind, ErrorKind::kUsage);
  view.width = view.height = 65536;
  EXPECT_EQ(renderer.render(view, plainOptions()).error().kind, ErrorKind::kUsage);
  view.width = view.height = 8;
  ReferenceOptions options = plainOptions();
  for (double quantile : {0.0, -1.0, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
    options.quantile = quantile;
    const Result<RenderedImages> images = renderer.render(view, options);
    ASSERT_FALSE(images);
    EXPECT_THAT(images.error().message, ::testing::HasSubstr("quantile"));
  }
}

TEST(Rendering, AFoamWithoutDensityIsBlack) {
  Foam foam = randomFoam(20, 1, 1, 1);
  foam.densities.assign(20, 0.0f);
  const RenderedImages images = renderFoam(foam, lookAt({0, 0, -3}, {0, 0, 0}, 8, 8, 0.6));
  for (float value : images.colour.values) EXPECT_EQ(value, 0);
  for (float value : images.distance.values) EXPECT_EQ(value, -1);
}

}  // namespace
}  // namespace froth
