// The error of a group: from which size of a pixel on its coarse form stands for it.
#include "baker/lod/group_error.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include "tests/lod/lod_scenes.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

TEST(GroupError, EqualFoamsHaveNone) {
  const Foam foam = randomFoam(200, 2, 2, 3);
  EXPECT_EQ(measureGroupError(foam, foam, 1), 0);
}

TEST(GroupError, GrowsWithTheDifference) {
  const Foam foam = randomFoam(200, 2, 2, 3);
  double before = 0;
  for (const float factor : {0.999f, 0.99f, 0.95f, 0.8f, 0.5f, 0.0f}) {
    const double error = measureGroupError(foam, withDimmedColours(foam, factor), 1);
    EXPECT_GT(error, before) << factor;
    before = error;
  }
}

TEST(GroupError, ACoarseFormWithAHoleHasAnError) {
  const Foam foam = randomFoam(200, 2, 2, 3);
  Foam holed = foam;
  for (uint32_t cell = 0; cell < 40; ++cell) holed.densities[cell] = 0;
  EXPECT_GT(measureGroupError(foam, holed, 1), 0.01);
  // Black cells on black ground: what they hide tells.
  const Foam black = withOneColour(foam, glm::vec3(0));
  EXPECT_GT(measureGroupError(black, withOneColour(holed, glm::vec3(0)), 1), 0.01);
}

TEST(GroupError, ScalesWithTheScene) {
  const Foam foam = randomFoam(200, 2, 2, 3), dimmed = withDimmedColours(foam, 0.8f);
  const double error = measureGroupError(foam, dimmed, 1);
  const double larger = measureGroupError(scaleFoam(foam, 10), scaleFoam(dimmed, 10), 1);
  EXPECT_NEAR(larger, 10 * error, 0.02 * larger);
}

TEST(GroupError, LargerPixelsHideFineDifferences) {
  const Foam foam = randomFoam(400, 1, 1, 3);
  Foam spotted = foam;  // half of the cells lighter, half darker
  for (size_t lobe = 0; lobe < spotted.lobeColours.size(); ++lobe) spotted.lobeColours[lobe] += lobe % 2 ? 0.1f : -0.1f;
  const std::vector<ErrorAtSize> curve = measureErrorCurve(foam, spotted, 1);
  ASSERT_GT(curve.size(), 4u);
  EXPECT_LT(curve.back().worst, 0.7 * curve.front().worst);
  for (size_t i = 1; i < curve.size(); ++i) EXPECT_LT(curve[i - 1].pixel, curve[i].pixel);
}

// Cells in two layers; those in front are the same, and what differs is behind them.
TEST(GroupError, CountsWhatIsSeenFromTheEyesAlone) {
  std::vector<PlainCell> cells;
  for (int layer = 0; layer < 2; ++layer) {
    for (int i = 0; i < 49; ++i) {
      cells.push_back({.site = {float(i % 7), float(i / 7), 3.0f * float(layer)}, .density = 100});
    }
  }
  const Foam foam = foamOf(cells);
  Foam changed = foam;
  for (size_t cell = 49; cell < 98; ++cell) changed.lobeColours[cell] += 0.3f;
  const std::vector<glm::vec3> before{{3, 3, -40}}, behind{{3, 3, 43}};
  EXPECT_LT(measureErrorCurve(foam, changed, 1, before).front().worst, 1e-3);
  EXPECT_GT(measureErrorCurve(foam, changed, 1, behind).front().worst, 0.05);
}

// An eye between both layers sees only the one before it, where it is first; the other lies behind it.
TEST(GroupError, RaysStartBesideTheirEye) {
  const Foam foam = foamOf({{.site = {0, 0, -3}, .density = 100}, {.site = {0, 0, 3}, .density = 100}});
  Foam changed = foam;
  changed.lobeColours[0] += 0.3f;
  const std::vector<glm::vec3> between{{0, 0, -1.5f}};
  EXPECT_EQ(measureGroupError(foam, changed, 1, between), 0);
}

TEST(GroupError, TheSameOnAnyNumberOfThreads) {
  const Foam foam = randomFoam(300, 2, 2, 8), dimmed = withDimmedColours(foam, 0.9f);
  const double onAll = measureGroupError(foam, dimmed, 2);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(measureGroupError(foam, dimmed, 2), onAll);
}

TEST(GroupError, AFoamThatShowsNothingHasNone) {
  Foam foam = randomFoam(20, 1, 1, 1);
  for (float& density : foam.densities) density = 0;
  EXPECT_EQ(measureGroupError(foam, foam, 1), 0);
}

}  // namespace
}  // namespace froth
