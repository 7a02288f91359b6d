// Merges that get pictures wrong are made otherwise.
#include "baker/lod/merge_review.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/lod/level_scene.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

TEST(MergeReview, AnOutlierIsWhatHasSixTimesTheMean) {
  std::vector<double> errors(100, 1.0);
  EXPECT_TRUE(findOutliers(errors).empty());
  errors[17] = 8;  // of a mean of 1.07
  errors[60] = 6;
  EXPECT_EQ(findOutliers(errors), std::vector<uint32_t>{17});
  EXPECT_TRUE(findOutliers(std::vector<double>(5, 0.0)).empty());
  EXPECT_TRUE(findOutliers({}).empty());
}

constexpr uint32_t kSide = 24;
constexpr float kSpacing = 1.4f;

// The greys of a cell's two detail sites: mean - contrast, mean + contrast.
struct Greys {
  float mean, contrast;
};

// Cells with two detail sites in the plane z = 0, whose faces look towards -z.
Foam wallOf(const std::function<Greys(uint32_t)>& greysOf) {
  std::vector<PlainCell> cells;
  for (uint32_t cell = 0; cell < kSide * kSide; ++cell) {
    const auto x = static_cast<float>(cell % kSide), y = static_cast<float>(cell / kSide);
    cells.push_back({.site = {kSpacing * x, kSpacing * y, 0},
                     .density = 100,
                     .colour = glm::vec3(0.5f),
                     .orientation = kFaceTowardsMinusZ,
                     .height = 0});
  }
  Foam foam = foamOf(cells);
  foam.detailCount = 2;
  foam.lobeAxes.resize(2 * foam.lobeAxes.size(), foam.lobeAxes[0]);
  foam.lobeColours.clear();
  foam.detailSites.clear();
  foam.detailHeights.assign(2 * size_t{foam.cellCount}, 0.0f);
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    foam.detailSites.insert(foam.detailSites.end(), {{0.0f, -0.35f}, {0.0f, 0.35f}});
    const Greys greys = greysOf(cell);
    for (const float sign : {-1.0f, 1.0f}) {
      foam.lobeColours.push_back(glm::vec3(greys.mean + sign * greys.contrast - 0.5f));
    }
  }
  return foam;
}

bool isHalved(uint32_t cell) { return cell % kSide % 6 < 2 && cell / kSide % 6 == 0; }

// Some pairs of neighbours are half black and half white each; all others have one colour, and neighbours in a row not
// the same.
Greys halvedAmongPlain(uint32_t cell) {
  if (isHalved(cell)) return {0.5f, 0.5f};
  return {0.41f + 0.03f * static_cast<float>(cell % 7), 0};
}

constexpr uint32_t kPlainColumns = 17;

// Plain cells merge without a loss, but are too few. Of the others the halved pairs cost least, and what merges in
// their place shows as much.
Greys halvedAmongHalved(uint32_t cell) {
  if (cell % kSide < kPlainColumns) return {0.5f, 0};
  if (isHalved(cell)) return {0.5f, 0.3f};
  return {0.32f + 0.06f * static_cast<float>(cell % 7), 0.3f};
}

// How many of the halved cells level 1 has.
size_t countKept(const Foam& foam, const AssetContents& contents) {
  size_t kept = 0;
  for (uint32_t index = 0; index < contents.chunks.size(); ++index) {
    if (contents.levels[index].level != 1) continue;
    const ChunkContents& chunk = contents.chunks[index];
    for (uint32_t local = 0; local < chunk.liveCount; ++local) {
      const glm::vec3 site = worldSite(chunk, local);
      for (uint32_t cell = 0; cell < foam.cellCount; ++cell) kept += isHalved(cell) && foam.sites[cell] == site;
    }
  }
  return kept;
}

Result<BakeResult> bakeWall(const Foam& foam) {
  CameraSet cameras;
  const float middle = 0.5f * kSpacing * (kSide - 1);
  for (int k = 0; k < 4; ++k) {
    cameras.views.push_back(lookAt({middle + k - 1.5, middle + 1.5 - k, -30}, {middle, middle, 0}, 160, 160, 0.7));
  }
  BakeOptions options;
  options.preset = "exact";
  options.knobs = *presetKnobs("exact");
  options.chunkCells = 150;
  options.levels = true;
  options.measure = false;
  options.cameras = &cameras;
  return bakeFoam(foam, options);
}

// A pair of halved cells differs in no mean colour, so it costs least, and its merged cell loses what it shows.
TEST(MergeReview, CellsWhoseMergesWouldShowStayAsTheyAre) {
  const Foam foam = wallOf(halvedAmongPlain);
  size_t halved = 0;
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) halved += isHalved(cell);
  const Result<BakeResult> baked = bakeWall(foam);
  ASSERT_TRUE(baked) << baked.error().message;
  const LevelReport& level = baked->levels.at(0);
  EXPECT_LT(level.live - level.merges, level.live);
  EXPECT_GE(level.reviews, 1u);
  EXPECT_GE(countKept(foam, baked->contents), halved * 9 / 10) << "of " << halved;
}

TEST(MergeReview, WhatGainsLittleIsTakenBack) {
  const Result<BakeResult> baked = bakeWall(wallOf(halvedAmongHalved));
  ASSERT_TRUE(baked) << baked.error().message;
  EXPECT_EQ(baked->levels.at(0).reviews, 0u);  // of two, were all kept
}

}  // namespace
}  // namespace froth
