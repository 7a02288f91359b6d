#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baker/bake/bake.h"
#include "reference/render/reference.h"
#include "tests/bake/random_foam.h"

namespace froth {
namespace {

TEST(FoamFromAsset, GivesTheLiveCellsBackAndEmptiesTheOthers) {
  Foam foam = makeRandomFoam(200, 2, 3, 2);
  for (uint32_t i = 0; i < 200; i += 7) foam.densities[i] = 0;
  BakeOptions options;
  options.steiner = false;
  const Result<BakeResult> baked = bakeFoam(foam, options);
  ASSERT_TRUE(baked);
  const Result<Foam> shown = foamFromAsset(baked->contents);
  ASSERT_TRUE(shown) << shown.error().message;

  const uint32_t liveCount = baked->contents.chunks[0].liveCount;
  ASSERT_EQ(shown->cellCount, baked->sourceCells.size());
  EXPECT_LT(liveCount, shown->cellCount);
  EXPECT_EQ(shown->lobeColours.size(), shown->cellCount * 6u);
  EXPECT_EQ(shown->detailHeights.size(), shown->cellCount * 2u);
  for (uint32_t place = 0; place < shown->cellCount; ++place) {
    const uint32_t cell = baked->sourceCells[place];
    EXPECT_EQ(shown->sites[place], foam.sites[cell]);
    EXPECT_EQ(shown->radii[place], foam.radii[cell]);
    const bool isLive = place < liveCount;
    EXPECT_EQ(shown->densities[place], isLive ? foam.densities[cell] : 0);
    EXPECT_EQ(shown->orientations[place], isLive ? foam.orientations[cell] : glm::vec4(1, 0, 0, 0));
    EXPECT_EQ(shown->detailHeights[2 * place + 1], isLive ? foam.detailHeights[2 * cell + 1] : 0);
    EXPECT_EQ(shown->lobeColours[6 * place + 5], isLive ? foam.lobeColours[6 * cell + 5] : glm::vec3(0));
  }
}

TEST(FoamFromAsset, IsTheFinestLevel) {
  const Foam foam = makeRandomFoam(900, 1, 1, 2);
  BakeOptions options;
  options.chunkCells = 100;
  options.steiner = false;
  const Result<BakeResult> plain = bakeFoam(foam, options);
  options.levels = true;
  const Result<BakeResult> baked = bakeFoam(foam, options);
  ASSERT_TRUE(plain && baked);
  ASSERT_FALSE(baked->contents.levels.empty());
  const Result<Foam> shown = foamFromAsset(baked->contents), expected = foamFromAsset(plain->contents);
  ASSERT_TRUE(shown && expected);
  EXPECT_EQ(shown->sites, expected->sites);
  EXPECT_EQ(shown->densities, expected->densities);
}

// Dropped, emptied and reordered cells leave no trace: the reference, which finds its neighbours on its own,
// draws the baked foam as it draws the input.
TEST(FoamFromAsset, ShowsTheImageOfTheInput) {
  const Foam foam = makeMixedFoam();
  const Result<BakeResult> baked = bakeFoam(foam, {});
  ASSERT_TRUE(baked);
  const Result<Foam> shown = foamFromAsset(baked->contents);
  ASSERT_TRUE(shown);

  View view;  // looks along z at the foam in [0, 10]^3
  view.width = view.height = 48;
  view.fx = view.fy = 48;
  view.cx = view.cy = 24;
  view.worldFromCamera = {1, 0, 0, 5, 0, 1, 0, 5, 0, 0, 1, -8};
  const Result<RenderedImages> expected = ReferenceRenderer(foam).render(view, {});
  const Result<RenderedImages> found = ReferenceRenderer(*shown).render(view, {});
  ASSERT_TRUE(expected && found);
  double energy = 0;
  for (size_t k = 0; k < expected->colour.values.size(); ++k) {
    energy += expected->colour.values[k];
    ASSERT_NEAR(found->colour.values[k], expected->colour.values[k], 1e-6) << k;
  }
  EXPECT_GT(energy, 100);
}

// Two chunks of one live and one dead cell each; the second lies at an origin.
TEST(FoamFromAsset, JoinsChunksInWorldCoordinates) {
  ChunkContents chunk;
  chunk.cellCount = 2;
  chunk.liveCount = 1;
  chunk.sites = {{1, 2, 3}, {4, 5, 6}};
  chunk.radii = {1, 2};
  chunk.densities = {5};
  chunk.orientations = {{0, 1, 0, 0}};
  chunk.detailSites = {{0.5f, 0.5f}};
  chunk.lobeAxes = {{1, 0, 0}};
  chunk.lobeColours = {{0.25f, 0, 0}};
  AssetContents contents;
  contents.detailCount = contents.lobeCount = 1;
  contents.chunks = {chunk, chunk};
  contents.chunks[1].origin = {1000, 0, -0.5};

  const Result<Foam> foam = foamFromAsset(contents);
  ASSERT_TRUE(foam) << foam.error().message;
  EXPECT_THAT(foam->sites, testing::ElementsAre(glm::vec3(1, 2, 3), glm::vec3(4, 5, 6), glm::vec3(1001, 2, 2.5f),
                                                glm::vec3(1004, 5, 5.5f)));
  EXPECT_THAT(foam->densities, testing::ElementsAre(5, 0, 5, 0));
  EXPECT_THAT(foam->detailHeights, testing::Each(0.0f));
  EXPECT_EQ(foam->detailHeights.size(), 4u);

  contents.chunks[1].lobeAxes.clear();
  const Result<Foam> broken = foamFromAsset(contents);
  ASSERT_FALSE(broken);
  EXPECT_THAT(broken.error().message, testing::HasSubstr("chunk 1"));
  EXPECT_FALSE(foamFromAsset(AssetContents{}));
}

// One live cell with two detail sites of one and no lobes, one dead cell, and a ghost that belongs to another chunk.
TEST(FoamFromAsset, KeepsBaseColoursAndVaryingLobesAndDropsGhosts) {
  ChunkContents chunk;
  chunk.cellCount = 2;
  chunk.liveCount = chunk.ghostCount = 1;
  chunk.sites = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  chunk.radii = {1, 2, 3};
  chunk.densities = {5};
  chunk.orientations = {{0, 1, 0, 0}};
  chunk.detailSites = {{0.5f, 0.5f}, {0, 0}};
  chunk.baseColours = {{0.25f, 0, 0}, {0, 0.25f, 0}};
  chunk.lobeCounts = {1, 0};
  chunk.lobeAxes = {{1, 0, 0}};
  chunk.lobeColours = {{0.125f, 0, 0}};
  AssetContents contents;
  contents.detailCount = 2;
  contents.lobeCount = 3;
  contents.chunks = {chunk};

  const Result<Foam> foam = foamFromAsset(contents);
  ASSERT_TRUE(foam) << foam.error().message;
  EXPECT_EQ(foam->cellCount, 2u);
  EXPECT_EQ(foam->sites.size(), 2u);
  EXPECT_EQ(foam->radii.size(), 2u);
  EXPECT_THAT(foam->baseColours,
              testing::ElementsAre(glm::vec3(0.25f, 0, 0), glm::vec3(0, 0.25f, 0), glm::vec3(0), glm::vec3(0)));
  EXPECT_THAT(foam->lobeOffsets, testing::ElementsAre(0, 1, 1, 1, 1));
  EXPECT_EQ(foam->lobeColours.size(), 1u);
}

}  // namespace
}  // namespace froth
