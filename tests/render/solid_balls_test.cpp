// What solid balls leave out does not show: images with and without them are the same bit for bit.
#include <array>

#include <gtest/gtest.h>

#include "baker/synth/synth.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

// By raster and walk. Lists of other lengths are drawn by one kernel: drivers may fuse the arithmetic of two in
// different ways.
std::array<Frame, 2> drawBoth(const AssetContents& contents, const View& view) {
  const VkExtent2D extent{view.width, view.height};
  Stage stage(contents, extent);
  FrothRenderInfo info = infoOf(view);
  info.tileForm = FROTH_TILE_FORM_ALL_SHORT;
  return {stage.draw(Method::kRaster, info, extent), stage.draw(Method::kWalk, info, extent)};
}

struct Pairs {
  uint64_t with, without;
};

Pairs expectSameImages(const Foam& foam, const View& view) {
  AssetContents contents = bakeForTest(foam);
  const std::array<Frame, 2> with = drawBoth(contents, view);
  for (ChunkContents& chunk : contents.chunks) {
    EXPECT_FALSE(chunk.solidBalls.empty());
    chunk.solidBalls.clear();
  }
  const std::array<Frame, 2> without = drawBoth(contents, view);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(with[i].colour.values, without[i].colour.values);
    EXPECT_EQ(with[i].alpha.values, without[i].alpha.values);
    EXPECT_EQ(with[i].distance.values, without[i].distance.values);
    EXPECT_EQ(with[i].normal.values, without[i].normal.values);
  }
  EXPECT_LE(with[0].status.pairs, without[0].status.pairs);
  return {with[0].status.pairs, without[0].status.pairs};
}

TEST(SolidBalls, ChangeNoBitOfARandomFoamSeenFromOutsideAndFromWithin) {
  for (const uint32_t seed : {1u, 2u}) {
    const Foam foam = makeRandomFoam(300, 4, 2, seed);
    expectSameImages(foam, lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, 160, 120, 0.6));
    expectSameImages(foam, lookAt({0.1, 0, 3}, {0.4, 0.3, 4}, 96, 72, 1.2));
    expectSameImages(foam, lookAt({3, -20, -30}, {0, 0, 3}, 160, 120, 0.1));
  }
}

// A cell is near by its whole ball: the solid ones of these cells are smaller, and their centres elsewhere.
TEST(SolidBalls, ChangeNoBitOfAViewWhoseNearTestsLeaveCellsOut) {
  const Foam foam = makeRandomFoam(300, 4, 2, 3);
  View view = lookAt({0.1, 0, 2.2}, {0.4, 0.3, 4}, 96, 72, 1.2);
  const Pairs all = expectSameImages(foam, view);
  view.nearRatio = 3;
  const Pairs byRatio = expectSameImages(foam, view);
  EXPECT_LT(byRatio.without, all.without);
  view.nearRatio = 0;
  view.nearDepth = 0.7;
  const Pairs byDepth = expectSameImages(foam, view);
  EXPECT_LT(byDepth.without, all.without);
}

TEST(SolidBalls, ChangeNoBitOfAGalleryAndSavePairs) {
  Result<Foam> foam = synthesizeFoam({"gallery", 5000, 1});
  ASSERT_TRUE(foam) << foam.error().message;
  for (const size_t view : {size_t{0}, size_t{3}}) {
    const Pairs pairs = expectSameImages(*foam, resizeView(galleryCameras().views.at(view), 320, 240));
    EXPECT_LT(pairs.with, pairs.without);
  }
}

}  // namespace
}  // namespace froth::test
