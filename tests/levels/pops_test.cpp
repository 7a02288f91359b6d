// A slow dolly: what is told of pixels that change, and that both of its scenes are the same where their cuts are.
#include <algorithm>

#include <gtest/gtest.h>

#include "measure/flight/pops.h"
#include "tests/render/render_harness.h"
#include "tests/surroundings.h"

namespace froth::test {
namespace {

Image imageOf(std::vector<float> values) { return {static_cast<uint32_t>(values.size() / 3), 1, 3, std::move(values)}; }

TEST(Pops, CountAPixelByItsChannelThatChangesMost) {
  PixelChanges changes;
  const FrameChange frame = changes.add(imageOf({0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1}),  //
                                        imageOf({0.25, 0, 0.5, 0.5, 0.5, 0.5, 1, 0.97, 1}));
  EXPECT_EQ(frame.most, 0.5);
  EXPECT_EQ(frame.seenPixels, 1u) << "0.03 is less than 8 / 255";
  EXPECT_EQ(changes.pixels(), 3u);
  EXPECT_NEAR(changes.quantile(0.3), 0, 1.0 / 4096);
  EXPECT_NEAR(changes.quantile(0.6), 0.03, 1.0 / 4096);
  EXPECT_NEAR(changes.quantile(1), 0.5, 1.0 / 4096);
}

// Towards the sample, from where a group of it begins to be refined some frames later.
View startOfDolly() { return lookAt({0.1, 0.2, -1.7}, {0, 0, 0}, 48, 32, 0.9); }

FlightOptions dollyOf(float detail, uint32_t frames) {
  FlightOptions options;
  options.frames = frames;
  options.scene.asset = sourceFolder() / "tests/format/golden/version_3_0.froth";
  options.scene.extent = {48, 32};
  options.scene.detail = detail;
  return options;
}

Pops measureWell(const FlightOptions& options) {
  Result<Pops> pops = measurePops(startOfDolly(), options, {});
  EXPECT_TRUE(pops) << pops.error().message;
  return pops ? std::move(*pops) : Pops();
}

uint32_t countMoved(const Pops& pops) {
  uint32_t chunks = 0;
  for (const FrameChange& frame : pops.levels) chunks += frame.movedChunks;
  return chunks;
}

TEST(Pops, AreThoseOfCutsAlone) {
  const Pops pops = measureWell(dollyOf(1, 40));
  EXPECT_NEAR(pops.step, 0.1 * pops.distance / 16, 1e-12);
  EXPECT_GT(pops.distance, 1.5);
  EXPECT_LT(pops.distance, 4);
  EXPECT_GT(countMoved(pops), 0u);
  EXPECT_EQ(pops.still.pixels() + pops.moved.pixels(), 39u * 48 * 32);
  EXPECT_GT(pops.moved.quantile(0.99), pops.still.quantile(0.99));

  EXPECT_TRUE(pops.faded.empty());

  const Pops whole = measureWell(dollyOf(1e30f, 6));
  EXPECT_EQ(countMoved(whole), 0u);
  ASSERT_EQ(whole.whole.size(), whole.levels.size());
  for (size_t i = 0; i < whole.whole.size(); ++i) {
    EXPECT_EQ(whole.levels[i].most, whole.whole[i].most) << i;
    EXPECT_EQ(whole.levels[i].seenPixels, whole.whole[i].seenPixels) << i;
    EXPECT_EQ(whole.levels[i].mostOfError, 0) << i;
  }
}

// A pop is a change of what is wrong; a fade spreads it over its frames.
TEST(Pops, AreSmallerWhereTheyFade) {
  FlightOptions options = dollyOf(1, 40);
  options.scene.fadeFrames = 7;
  const Pops pops = measureWell(options);
  ASSERT_EQ(pops.faded.size(), pops.levels.size());
  const auto mostOf = [](const std::vector<FrameChange>& frames) {
    return std::ranges::max_element(frames, {}, &FrameChange::mostOfError)->mostOfError;
  };
  EXPECT_GT(mostOf(pops.levels), 0.05);
  EXPECT_LT(mostOf(pops.faded), 0.75 * mostOf(pops.levels)) << "what is wrong moves with the camera, too";
  EXPECT_EQ(pops.gpuFading.size() % 7, 0u);
  EXPECT_GT(pops.gpuFading.size(), 0u);
  EXPECT_EQ(pops.gpuFading.size() + pops.gpuStill.size() + 1, pops.faded.size());
}

}  // namespace
}  // namespace froth::test
