// Measured visibility against rays written from the definition alone, and against what a wall hides.
#include "baker/appearance/visibility.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "tests/reference/scenes.h"

namespace froth {
namespace {

Visibility measure(const Foam& foam, const std::vector<View>& views) {
  VisibilityOptions options;
  options.nearRatio = 0;
  Result<Visibility> visibility = measureVisibility(foam, views, options);
  EXPECT_TRUE(visibility);
  return std::move(*visibility);
}

double weightOf(const Visibility& visibility, uint64_t site) {
  double sum = 0;
  for (uint64_t i = visibility.offsets[site]; i < visibility.offsets[site + 1]; ++i) sum += visibility.weights[i];
  return sum;
}

// One ball without neighbours, solid throughout: a ray's share is alpha = 1 - exp(-density * chord).
TEST(Visibility, WeightOfALoneBallIsItsSumOfSquaredOpacities) {
  const Foam foam = foamOf(
      {{.site = {0, 0, 0}, .radius = 1, .density = 0.7f, .orientation = kFaceTowardsPlusZ}});  // rays leave through it
  const View view = lookAt({0.1, 0.2, -4}, {0, 0, 0}, 32, 24, 0.5);
  const Visibility visibility = measure(foam, {view});
  double sum = 0, largest = 0;
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const glm::dvec3 d = directionOf(view, x, y), eye(0.1, 0.2, -4);
      const double along = -glm::dot(eye, d), squared = 1 - (glm::dot(eye, eye) - along * along);
      if (squared <= 0) continue;
      const double alpha = -std::expm1(-0.7f * 2 * std::sqrt(squared));
      sum += alpha * alpha;
      largest = std::max(largest, alpha);
    }
  }
  ASSERT_EQ(visibility.weights.size(), 1u);
  EXPECT_NEAR(visibility.weights[0], sum, 1e-3 * sum);
  EXPECT_NEAR(visibility.contributions[0], largest, 1e-4);
}

TEST(Visibility, ReducedViewsCountPixelsOfTheFullSize) {
  const Foam foam = foamOf({{.site = {0, 0, 0}, .radius = 1, .density = 2}});
  VisibilityOptions options;
  options.nearRatio = 0;
  const std::vector<View> views = {lookAt({0, 0.1, -4}, {0, 0, 0}, 256, 192, 0.5)};
  const double full = weightOf(measure(foam, views), 0);
  options.maxPixelsPerView = 3000;
  const Result<Visibility> reduced = measureVisibility(foam, views, options);
  ASSERT_TRUE(reduced);
  EXPECT_NEAR(weightOf(*reduced, 0), full, 0.05 * full);
}

TEST(Visibility, WhatAWallHidesIsNotSeen) {
  //   eye ->   (wall)   (ball)
  const Foam foam =
      foamOf({{.site = {0, 0, 0}, .radius = 1, .density = 1000}, {.site = {0, 0, 3}, .radius = 0.5f, .density = 5}});
  const Visibility front = measure(foam, {lookAt({0.1, 0, -4}, {0, 0, 0}, 32, 32, 0.5)});
  EXPECT_GT(weightOf(front, 0), 0);
  EXPECT_EQ(weightOf(front, 1), 0);
  EXPECT_LT(front.contributions[1], 1e-3f);
  const Visibility behind = measure(foam, {lookAt({0.1, 0, 7}, {0, 0, 0}, 32, 32, 0.5)});
  EXPECT_GT(weightOf(behind, 1), 0);
}

TEST(Visibility, RowsAscendAndOverlapsAreCorrelations) {
  const Foam foam = randomFoam(60, 4, 2, 3);
  std::vector<View> views;
  for (int i = 0; i < 5; ++i) {
    views.push_back(lookAt({3 * std::cos(i), 0.3 * i, 3 * std::sin(i)}, {0, 0, 0}, 24, 20, 0.6));
  }
  const Visibility visibility = measure(foam, views);
  ASSERT_EQ(visibility.offsets.size(), 60 * 4 + 1u);
  ASSERT_EQ(visibility.overlaps.size(), 60 * 6u);
  EXPECT_EQ(visibility.eyes.size(), 5u);
  for (size_t site = 0; site + 1 < visibility.offsets.size(); ++site) {
    for (uint64_t i = visibility.offsets[site]; i < visibility.offsets[site + 1]; ++i) {
      EXPECT_GT(visibility.weights[i], 0);
      if (i > visibility.offsets[site]) {
        EXPECT_LT(visibility.views[i - 1], visibility.views[i]);
      }
    }
  }
  for (float overlap : visibility.overlaps) EXPECT_TRUE(overlap >= 0 && overlap <= 1);
  EXPECT_GT(*std::max_element(visibility.overlaps.begin(), visibility.overlaps.end()), 0.1f);
}

TEST(Visibility, OfSeveralViewsIsThatOfEachAlone) {
  const Foam foam = randomFoam(60, 4, 2, 3);
  std::vector<View> views;
  for (int i = 0; i < 3; ++i) {
    views.push_back(lookAt({3 * std::cos(i), 0.3 * i, 3 * std::sin(i)}, {0, 0, 0}, 24, 20, 0.6));
  }
  const Visibility together = measure(foam, views);
  std::vector<float> contributions(60, 0);
  uint64_t entries = 0;
  for (uint16_t v = 0; v < views.size(); ++v) {
    const Visibility alone = measure(foam, {views[v]});
    entries += alone.weights.size();
    for (size_t site = 0; site + 1 < alone.offsets.size(); ++site) {
      if (alone.offsets[site] == alone.offsets[site + 1]) continue;
      const auto row = together.views.begin();
      const auto found = std::find(row + together.offsets[site], row + together.offsets[site + 1], v) - row;
      ASSERT_LT(static_cast<uint64_t>(found), together.offsets[site + 1]) << "view " << v << ", site " << site;
      EXPECT_EQ(together.weights[found], alone.weights[alone.offsets[site]]);
    }
    for (size_t cell = 0; cell < contributions.size(); ++cell) {
      contributions[cell] = std::max(contributions[cell], alone.contributions[cell]);
    }
  }
  EXPECT_EQ(together.weights.size(), entries);
  EXPECT_EQ(together.contributions, contributions);
}

// The quarters of an image, each a view whose axis runs through one of its corners, see what the image sees.
//   +---+---+
//   |   |   |     * the axis of all
//   +---*---+
//   |   |   |
//   +---+---+
TEST(Visibility, OfAnImageIsTheSumOverItsQuarters) {
  const Foam foam = randomFoam(80, 3, 2, 7);
  const View whole = lookAt({2.5, 0.4, 1}, {0, 0, 0}, 48, 40, 0.5);
  std::vector<double> sums(80 * 3, 0);
  for (const uint32_t quarter : {0u, 1u, 2u, 3u}) {
    View view = whole;
    view.width /= 2;
    view.height /= 2;
    view.cx = quarter % 2 == 0 ? whole.cx : whole.cx - view.width;
    view.cy = quarter / 2 == 0 ? whole.cy : whole.cy - view.height;
    const Visibility visibility = measure(foam, {view});
    EXPECT_GT(visibility.weights.size(), 20u);
    for (size_t site = 0; site < sums.size(); ++site) sums[site] += weightOf(visibility, site);
  }
  const Visibility expected = measure(foam, {whole});
  for (size_t site = 0; site < sums.size(); ++site) {
    EXPECT_NEAR(sums[site], weightOf(expected, site), 1e-4 * sums[site] + 1e-6) << site;
  }
}

TEST(Visibility, ThreadsDoNotChangeIt) {
  const Foam foam = randomFoam(200, 3, 2, 5);
  const std::vector<View> views = {lookAt({3, 0.2, 0.5}, {0, 0, 0}, 40, 30, 0.6),
                                   lookAt({-3, 0.2, 1}, {0, 0, 0}, 40, 30, 0.6)};
  const Visibility many = measure(foam, views);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Visibility alone = measure(foam, views);
  EXPECT_EQ(many.weights, alone.weights);
  EXPECT_EQ(many.overlaps, alone.overlaps);
  EXPECT_EQ(many.contributions, alone.contributions);
}

TEST(Visibility, StopsOnRequest) {
  const Foam foam = randomFoam(20, 1, 1, 1);
  const std::vector<View> views = {lookAt({3, 0.2, 0.5}, {0, 0, 0}, 8, 8, 0.6)};
  const auto result = measureVisibility(foam, views, {}, [](auto, auto, auto) { return false; });
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace froth
