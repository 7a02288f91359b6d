// Two cells become one that looks like both.
#include "baker/lod/merge_cells.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include "baker/lod/choose_pairs.h"
#include "foam/detail_colour.h"
#include "tests/lod/lod_scenes.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

std::vector<CellPair> allPairs(const Foam& foam) {
  return choosePairs(foam, std::vector<uint8_t>(foam.cellCount, 0), {}, foam.cellCount);
}

void expectComplete(const Foam& merged, const Foam& foam, size_t cells) {
  const size_t details = cells * foam.detailCount;
  EXPECT_EQ(merged.cellCount, cells);
  EXPECT_EQ(merged.detailCount, foam.detailCount);
  EXPECT_EQ(merged.lobeCount, foam.lobeCount);
  EXPECT_EQ(merged.orientations.size(), cells);
  EXPECT_EQ(merged.detailSites.size(), details);
  EXPECT_EQ(merged.detailHeights.size(), details);
  EXPECT_EQ(merged.baseColours.size(), foam.baseColours.empty() ? 0 : details);
  EXPECT_EQ(merged.lobeOffsets.size(), foam.lobeOffsets.empty() ? 0 : details + 1);
  EXPECT_EQ(merged.lobeAxes.size(), foam.lobeOffsets.empty() ? details * foam.lobeCount : merged.lobeOffsets.back());
  EXPECT_EQ(merged.lobeColours.size(), merged.lobeAxes.size());
  for (uint32_t cell = 0; cell < merged.cellCount; ++cell) {
    EXPECT_TRUE(std::isfinite(glm::length(merged.sites[cell])));
    EXPECT_GT(merged.radii[cell], 0);
    EXPECT_GT(merged.densities[cell], 0);
    EXPECT_NEAR(glm::length(merged.orientations[cell]), 1, 1e-5);
  }
}

//   ( | )  two copies of a cell, each cut by the other, that together are nearly one ball
TEST(MergeCells, TwoHalvesOfACellAreThatCell) {
  const PlainCell whole{.site = {3, -2, 1},
                        .radius = 2,
                        .density = 0.7f,
                        .colour = {0.2f, 0.6f, 0.9f},
                        .orientation = kFaceTowardsPlusZ,
                        .height = 0};
  PlainCell left = whole, right = whole;
  left.site.x -= 0.3f;
  right.site.x += 0.3f;
  const std::vector<CellPair> pair{{0, 1}};
  const std::vector<double> contributions{1000, 1};  // weigh colours, and leave the shape
  const Foam merged = mergePairs(foamOf({left, right}), pair, contributions), expected = foamOf({whole});
  ASSERT_EQ(merged.cellCount, 1u);
  EXPECT_NEAR(glm::distance(merged.sites[0], whole.site), 0, 0.1);
  EXPECT_NEAR(merged.radii[0], 2, 0.15);
  EXPECT_NEAR(merged.densities[0], 0.7, 0.05);
  EXPECT_NEAR(faceFrame<float>(merged.orientations[0]).normal.z, 1, 1e-5);
  EXPECT_EQ(merged.detailHeights[0], 0);  // plain faces stay plain
  for (const glm::vec3& d : {glm::vec3(0, 0, -1), glm::vec3(0.6f, 0, -0.8f)}) {
    EXPECT_NEAR(glm::distance(detailColour(merged, 0, d), detailColour(expected, 0, d)), 0, 1e-4);
  }
}

// A face at n . (x - p) = h stays where it is, wherever the merged site lies.
TEST(MergeCells, TheFaceStaysInItsPlace) {
  PlainCell left{.site = {-0.4f, 0, 0}, .radius = 1, .orientation = kFaceTowardsPlusZ, .height = 0.3f}, right = left;
  right.site.x = 0.4f;
  const std::vector<CellPair> pair{{0, 1}};
  const Foam merged = mergePairs(foamOf({left, right}), pair, {});
  EXPECT_NEAR(merged.sites[0].z + merged.radii[0] * merged.detailHeights[0], 0.3, 0.02);
}

TEST(MergeCells, AContributionDecidesTheNormal) {
  const std::vector<PlainCell> cells{{.site = {-0.4f, 0, 0}, .orientation = kFaceTowardsPlusZ, .height = 0.1f},
                                     {.site = {0.4f, 0, 0}, .orientation = {1, 0, 0, 0}, .height = 0.1f}};
  const std::vector<CellPair> pair{{0, 1}};
  const std::vector<double> contributions{100, 1};
  const glm::vec3 normal = faceFrame<float>(mergePairs(foamOf(cells), pair, contributions).orientations[0]).normal;
  EXPECT_GT(normal.z, 0.999);
}

TEST(MergeCells, OneColourStaysThatColourFromEveryDirection) {
  const glm::vec3 colour(0.3f, 0.7f, 0.4f);
  for (const uint32_t lobes : {1u, 4u}) {
    const Foam foam = withOneColour(randomFoam(120, 3, lobes, 5), colour);
    const Foam merged = mergePairs(foam, allPairs(foam), {});
    for (uint64_t detail = 0; detail < merged.detailSites.size(); ++detail) {
      for (const glm::vec3& d :
           {glm::vec3(1, 0, 0), glm::vec3(0, -1, 0), glm::vec3(0, 0, 1), glm::vec3(-0.6f, 0, 0.8f)}) {
        EXPECT_NEAR(glm::distance(detailColour(merged, detail, d), colour), 0, 1e-3) << detail;
      }
    }
  }
}

TEST(MergeCells, AnyNumberOfDetailSitesAndLobesIsMerged) {
  for (const uint32_t details : {1u, 2u, 8u, 32u}) {
    const Foam foam = randomFoam(60, details, 5, 2), bare = withBaseColours(foam);
    const std::vector<CellPair> pairs = allPairs(foam);
    ASSERT_GT(pairs.size(), 10u);
    expectComplete(mergePairs(foam, pairs, {}), foam, pairs.size());
    const Foam merged = mergePairs(bare, pairs, {});
    expectComplete(merged, bare, pairs.size());
    EXPECT_NEAR(glm::distance(merged.baseColours[0], glm::vec3(0.1f, 0.2f, -0.3f)), 0, 1e-4);
  }
}

TEST(MergeCells, LobesOfACompressedFoamKeepTheirCounts) {
  Foam foam = randomFoam(40, 2, 3, 2);
  foam.baseColours.assign(foam.detailSites.size(), glm::vec3(0));
  foam.lobeOffsets = {0};
  std::vector<glm::vec3> axes, colours;
  for (size_t detail = 0; detail < foam.detailSites.size(); ++detail) {
    for (size_t m = 0; m < detail % 4; ++m) {
      axes.push_back(foam.lobeAxes[detail * 3 + m]);
      colours.push_back(foam.lobeColours[detail * 3 + m]);
    }
    foam.lobeOffsets.push_back(axes.size());
  }
  foam.lobeAxes = axes;
  foam.lobeColours = colours;
  const std::vector<CellPair> pairs = allPairs(foam);
  expectComplete(mergePairs(foam, pairs, {}), foam, pairs.size());
}

TEST(MergeCells, TheSameOnAnyNumberOfThreads) {
  const Foam foam = randomFoam(300, 4, 3, 5);
  const std::vector<CellPair> pairs = allPairs(foam);
  const Foam onAll = mergePairs(foam, pairs, {});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Foam onOne = mergePairs(foam, pairs, {});
  EXPECT_EQ(onOne.sites, onAll.sites);
  EXPECT_EQ(onOne.densities, onAll.densities);
  EXPECT_EQ(onOne.detailSites, onAll.detailSites);
  EXPECT_EQ(onOne.detailHeights, onAll.detailHeights);
  EXPECT_EQ(onOne.lobeColours, onAll.lobeColours);
}

}  // namespace
}  // namespace froth
