// Errors of groups are errors of pictures.
#include "baker/lod/level_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "baker/bake/bake.h"
#include "baker/lod/cut.h"
#include "base/image/mean_square.h"
#include "reference/camera/view_rays.h"
#include "tests/bake/random_foam.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

// Two groups, each of a fine chunk of one cell (0 and 1) and a coarse one (2 and 3).
std::vector<LevelChunk> twoGroups() {
  std::vector<LevelChunk> chunks(4);
  for (uint32_t k = 0; k < 2; ++k) {
    chunks[k].place = {0, kNoGroup, k};
    chunks[2 + k].place = {1, k, kNoGroup};
  }
  return chunks;
}

std::vector<LevelGroup> measureTwo(const Foam& fine, const Foam& coarse, const View& view) {
  const std::vector<View> views{view};
  LevelErrors errors(views, {.nearRatio = 0});
  const std::vector<LevelChunk> chunks = twoGroups();
  std::vector<LevelGroup> groups(2);
  std::vector<GroupBounds> bounds;
  for (uint32_t k = 0; k < 2; ++k) {
    const glm::vec3& site = fine.sites[k];
    groups[k] = {{site.x, site.y, site.z}, 1, 0.1, 0};
    const glm::dvec3 centre(site);
    bounds.push_back({centre - 1.0, centre + 1.0});
  }
  EXPECT_TRUE(errors.takeFinest(fine, std::vector<uint32_t>{0, 1}, {}));
  EXPECT_TRUE(errors.addLevel(coarse, std::vector<uint32_t>{2, 3}, chunks, 0, 2, {}));
  errors.finish(chunks, bounds, groups);
  return groups;
}

Foam twoBalls(const glm::vec3& second, float added) {
  return foamOf(
      {{.site = {0, 0, 0}, .density = 1000}, {.site = second, .density = 1000, .colour = glm::vec3(0.3f + added)}});
}

TEST(LevelErrors, AGroupThatLooksDifferentHasTheGreaterOne) {
  const glm::vec3 beside(3, 0, 0);
  const View view = lookAt({1.5, 0.01, -8}, {1.5, 0, 0}, 60, 40, 0.4);
  const std::vector<LevelGroup> groups = measureTwo(twoBalls(beside, 0), twoBalls(beside, 0.3f), view);
  // That of the other is guessed: half of what the distance of its forms, which is the same, lets expect.
  EXPECT_NEAR(groups[0].error, 0.5 * groups[1].error, 1e-6 * groups[1].error);
}

TEST(LevelErrors, WhatIsHiddenIsGuessed) {
  const glm::vec3 behind(0, 0, 4);
  const View view = lookAt({0.01, 0, -8}, {0, 0, 0}, 60, 40, 0.2);
  Foam coarse = twoBalls(behind, 0.3f);
  coarse.lobeColours[0] += 0.1f;
  const std::vector<LevelGroup> groups = measureTwo(twoBalls(behind, 0), coarse, view);
  EXPECT_NEAR(groups[1].error, 0.5 * groups[0].error, 1e-6 * groups[0].error);
}

TEST(LevelErrors, AreSummedByWhatShowsThem) {
  const glm::vec3 beside(3, 0, 0);
  const View view = lookAt({1.5, 0.01, -8}, {1.5, 0, 0}, 60, 40, 0.4);
  const Foam fine = twoBalls(beside, 0), coarse = twoBalls(beside, 0.3f);
  LevelErrors errors(std::vector<View>{view}, {.nearRatio = 0});
  ASSERT_TRUE(errors.takeFinest(fine, std::vector<uint32_t>{0, 1}, {}));
  const LevelErrors::OwnerErrors both = *errors.sumByOwner(coarse, std::vector<uint32_t>{1, 0}, 2, {});
  const std::vector<double>& sums = both.ofOwners;
  ASSERT_EQ(sums.size(), 2u);
  EXPECT_EQ(sums[1], 0);
  const auto colourOf = [&](const Foam& foam) { return renderFoam(foam, view).colour; };
  EXPECT_NEAR(sums[0], 60 * 40 * meanSquare(colourOf(fine), colourOf(coarse)), 1e-3 * sums[0]);
  EXPECT_NEAR(both.ofAll, sums[0], 1e-12 * sums[0]);
  const LevelErrors::OwnerErrors none = *errors.sumByOwner(coarse, std::vector<uint32_t>{kNoOwner, kNoOwner}, 1, {});
  EXPECT_EQ(none.ofOwners, std::vector<double>{0});
  EXPECT_EQ(none.ofAll, both.ofAll);
}

// The cut that a reader draws at detail 1 for a view (docs/STREAMING.md), as a foam; counts the refined groups.
Foam drawnCut(const AssetContents& contents, const View& view, size_t& refined) {
  std::vector<uint8_t> isRefined;
  const std::vector<GroupBounds> bounds = boundGroups(contents);
  for (size_t group = 0; group < bounds.size(); ++group) {
    const double nearest = distanceTo(bounds[group], eyeOf(view));
    isRefined.push_back(contents.groups[group].error >= nearest / view.fx);
    refined += isRefined.back();
  }
  return *foamFromAsset(*contentsOfCut(contents, isRefined));
}

TEST(LevelErrors, CutsAtDetail1LookAsLevel0) {
  const Foam foam = makeRandomFoam(3000, 2, 2, 5);
  CameraSet cameras;
  std::vector<View> others;          // that the bake does not see
  const glm::dvec3 middle(5, 5, 5);  // of the foam, which is some 10 wide
  for (const double distance : {12.0, 60.0, 250.0, 1000.0}) {
    for (int k = 0; k < 3; ++k) {
      const auto viewAt = [&](double angle) {
        const glm::dvec3 direction(std::cos(angle), std::sin(angle), 0.3);
        return lookAt(middle + distance * direction, middle, 160, 120, 0.5);
      };
      cameras.views.push_back(viewAt(2.1 * k));
      others.push_back(viewAt(2.1 * k + 0.1));
    }
  }
  BakeOptions options;
  options.chunkCells = 200;
  options.levels = true;
  options.measure = false;
  options.cameras = &cameras;
  const AssetContents contents = bakeFoam(foam, options)->contents;
  const ReferenceRenderer finest(foam);
  size_t refined = 0;
  double sum = 0;
  for (const View& view : others) {
    const Foam cut = drawnCut(contents, view, refined);
    const ReferenceRenderer drawn(cut);
    ReferenceOptions reference;
    reference.precision = Precision::kFloat;
    const double square = meanSquare(finest.render(view, reference)->colour, drawn.render(view, reference)->colour);
    EXPECT_LT(square, std::pow(10, -3.6)) << decibels(square);
    sum += square / static_cast<double>(others.size());
  }
  EXPECT_LT(sum, std::pow(10, -3.8)) << decibels(sum);
  EXPECT_GT(refined, 0u);
  EXPECT_LT(refined, others.size() * contents.groups.size()) << "all views draw all of level 0";
}

}  // namespace
}  // namespace froth
