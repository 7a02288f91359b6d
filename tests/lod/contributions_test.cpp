// What each cell contributes to views.
#include "baker/lod/contributions.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/reference/scenes.h"

namespace froth {
namespace {

TEST(Contributions, AddUpToTheCoverageOfTheViews) {
  const Foam foam = randomFoam(60, 3, 2, 9);
  const std::vector<View> views{lookAt({0.1, 0.2, -6}, {0, 0, 0}, 40, 30, 0.3),
                                lookAt({5, 1, 0}, {0, 0, 0}, 40, 30, 0.3)};
  const Result<std::vector<double>> found = measureContributions(foam, views, {.nearRatio = 0});
  ASSERT_TRUE(found) << found.error().message;
  double covered = 0;
  for (const View& view : views) {
    for (const float alpha : renderFoam(foam, view).alpha.values) covered += double{alpha};
  }
  EXPECT_GT(covered, 100);
  EXPECT_NEAR(std::accumulate(found->begin(), found->end(), 0.0), covered, 2e-3 * covered);  // the cutoff is 1e-3
}

TEST(Contributions, ACellBehindAnOpaqueOneContributesNothing) {
  const Foam foam =
      foamOf({{.site = {0, 0, 0}, .density = 1000}, {.site = {0, 0, 3}, .radius = 0.5f, .density = 1000}});
  const std::vector<View> views{lookAt({0.01, 0, -6}, {0, 0, 0}, 32, 32, 0.3)};
  const std::vector<double> found = *measureContributions(foam, views, {.nearRatio = 0});
  EXPECT_GT(found[0], 10);
  EXPECT_EQ(found[1], 0);
}

}  // namespace
}  // namespace froth
