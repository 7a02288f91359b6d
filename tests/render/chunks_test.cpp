// Assets of several chunks draw the image of the same asset in one.
#include <cmath>

#include <gtest/gtest.h>

#include "baker/synth/synth.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"
#include "tests/render/split_asset.h"

namespace froth::test {
namespace {

constexpr uint32_t kWidth = 128, kHeight = 96;
constexpr double kGrid = 0x1p-16;

View frontView() { return lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, kWidth, kHeight, 0.6); }

Foam synthesize(const char* name, uint32_t cells) {
  Result<Foam> foam = synthesizeFoam({name, cells, 1});
  EXPECT_TRUE(foam) << foam.error().message;
  for (glm::vec3& site : foam->sites) {
    for (int axis = 0; axis < 3; ++axis) site[axis] = snapToStep(site[axis], static_cast<float>(kGrid));
  }
  return *foam;
}

struct Pair {
  Frame raster, walk;
};

// A context draws one asset at a time.
std::vector<Pair> drawBoth(const AssetContents& contents, const std::vector<View>& views) {
  Stage stage(contents, {kWidth, kHeight});
  std::vector<Pair> pairs;
  for (const View& view : views) {
    pairs.push_back({stage.draw(Method::kRaster, view), stage.draw(Method::kWalk, view)});
    EXPECT_EQ(pairs.back().walk.status.bits, 0u) << "a walk did not end";
  }
  return pairs;
}

void expectSameImages(const AssetContents& whole, const AssetContents& chunked, const std::vector<View>& views) {
  const std::vector<Pair> expected = drawBoth(whole, views), found = drawBoth(chunked, views);
  for (size_t i = 0; i < views.size(); ++i) {
    EXPECT_GE(psnr(found[i].raster.colour, expected[i].raster.colour), 100) << "view " << i;
    EXPECT_GE(psnr(found[i].walk.colour, expected[i].walk.colour), 95) << "view " << i;
    EXPECT_GE(psnr(found[i].walk.colour, found[i].raster.colour), 60) << "view " << i;
    // Each walk crosses the same cells, up to rounding.
    const auto steps = static_cast<double>(expected[i].walk.status.work.steps);
    EXPECT_NEAR(static_cast<double>(found[i].walk.status.work.steps), steps, 1e-3 * steps) << "view " << i;
  }
}

// From outside, and from between the cells of different chunks.
std::vector<View> viewsAround() {
  return {frontView(), lookAt({0.3, 0.2, 2.6}, {0, -0.1, 3.4}, kWidth, kHeight, 0.9),
          lookAt({3.5, 0.1, 3}, {0, 0, 3}, kWidth, kHeight, 0.4)};
}

TEST(Chunks, InWorldCoordinatesGiveTheRasterOfOneChunkBitForBit) {
  const AssetContents whole = bakeForTest(synthesize("random", 0));
  const std::vector<Pair> expected = drawBoth(whole, {frontView()});
  const std::vector<Pair> found = drawBoth(splitAsset(whole, 8, 0), {frontView()});
  EXPECT_EQ(found[0].raster.colour.values, expected[0].raster.colour.values);
  EXPECT_EQ(found[0].raster.distance.values, expected[0].raster.distance.values);
  EXPECT_EQ(found[0].raster.normal.values, expected[0].raster.normal.values);
  EXPECT_GE(psnr(found[0].walk.colour, expected[0].walk.colour), 95);
}

TEST(Chunks, WithOriginsOfTheirOwnGiveTheImageOfOneChunk) {
  const AssetContents whole = bakeForTest(synthesize("random", 0));
  expectSameImages(whole, splitAsset(whole, 2, kGrid), viewsAround());
}

TEST(Chunks, OfAFewCellsGiveTheImageOfOneChunk) {
  const AssetContents whole = bakeForTest(synthesize("random", 0));
  ASSERT_GE(whole.chunks[0].cellCount, 400u);
  expectSameImages(whole, splitAsset(whole, 100, kGrid), viewsAround());
}

TEST(Chunks, OfAGalleryGiveTheImageOfOneChunk) {
  const AssetContents whole = bakeForTest(synthesize("gallery", 5000));
  std::vector<View> views;
  for (const size_t index : {0, 5}) {
    views.push_back(resizeView(galleryCameras().views.at(index), kWidth, kHeight));
  }
  expectSameImages(whole, splitAsset(whole, 37, kGrid), views);
}

// Rays along the axes of a cubic lattice: all keys of a layer of cells tie, in every chunk that knows them.
//
//    eye > o | o | o      one chunk per cell: every step enters another chunk
//    ------> o | o | o
//
TEST(Chunks, OfOneCellEachLetWalksAlongALatticeEnd) {
  Foam foam = makeRandomFoam(125, 1, 1, 3);
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    foam.sites[cell] = 0.25f * glm::vec3(cell % 5, cell / 5 % 5, cell / 25);
    foam.radii[cell] = 0.2f;
    foam.densities[cell] = 0.25f;
  }
  const AssetContents whole = bakeForTest(foam);
  const View along = lookAt({0.5, 0.5, -3}, {0.5, 0.5, 3}, kWidth, kHeight, 0.25);
  View straight = along;
  straight.worldFromCamera = {1, 0, 0, 0.5, 0, 1, 0, 0.5, 0, 0, 1, -3};
  View across = straight;
  across.worldFromCamera = {0, 0, 1, -1, 1, 0, 0, 0.375, 0, 1, 0, 0.375};  // along x, between the cells
  expectSameImages(whole, splitAsset(whole, foam.cellCount, kGrid), {along, straight, across});
}

// Each chunk says that the other one's cell lies behind its own, so that only the key ends a walk:
//
//    chunk 0:   eye > cell   ghost of 1
//    chunk 1:            cell   ghost of 0
//
TEST(Chunks, WhoseGhostsAreMisplacedCannotMakeAWalkCycle) {
  Foam foam = makeRandomFoam(2, 1, 1, 3);
  foam.sites = {{0, 0, 3}, {0, 0, 3.5f}};
  foam.radii = {0.4f, 0.4f};
  foam.densities = {0.1f, 0.1f};
  BakeOptions options;
  options.steiner = false;
  const Result<BakeResult> baked = bakeFoam(foam, options);
  ASSERT_TRUE(baked) << baked.error().message;
  AssetContents contents = splitAsset(baked->contents, 2, kGrid);
  ChunkContents& second = contents.chunks[1];
  ASSERT_EQ(second.ghostCount, 1u);
  second.sites[1] = second.sites[0] + glm::vec3(0, 0, 0.5f);
  constexpr bool kKeepForQueries = false;  // an asset that is kept for them has its ghosts checked
  Stage stage(contents, {kWidth, kHeight}, sharedContext(), 0, 0, false, 0, kKeepForQueries);
  FrothRenderInfo info = infoOf(frontView());
  info.maxSteps = 100;
  EXPECT_EQ(stage.draw(Method::kWalk, info, {kWidth, kHeight}).status.bits, 0u);
}

TEST(Chunks, FarFromTheOriginLookTheSame) {
  constexpr double kFar = 1 << 20;
  const AssetContents whole = bakeForTest(synthesize("random", 0));
  const std::vector<Pair> expected = drawBoth(whole, {frontView()});
  AssetContents far = splitAsset(whole, 12, kGrid);
  for (ChunkContents& chunk : far.chunks) {
    for (double& part : chunk.origin) part += kFar;
  }
  View view = frontView();
  for (const size_t axis : {3, 7, 11}) view.worldFromCamera[axis] += kFar;
  const std::vector<Pair> found = drawBoth(far, {view});
  EXPECT_GE(psnr(found[0].raster.colour, expected[0].raster.colour), 100);
  EXPECT_GE(psnr(found[0].walk.colour, expected[0].walk.colour), 95);
}

}  // namespace
}  // namespace froth::test
