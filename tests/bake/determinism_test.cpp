// The same foam and options give the same chunks: on any number of threads, a second time, with any memory limit.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "baker/bake/bake.h"
#include "tests/bake/random_foam.h"

namespace froth {
namespace {

BakeResult bake(const Foam& foam, const BakeOptions& options, size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  Result<BakeResult> result = bakeFoam(foam, options);
  EXPECT_TRUE(result) << result.error().message;
  return std::move(*result);
}

void expectSameChunk(const ChunkContents& a, const ChunkContents& b) {
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.liveCount, b.liveCount);
  EXPECT_EQ(a.sites, b.sites);
  EXPECT_EQ(a.radii, b.radii);
  EXPECT_EQ(a.ghostRefs, b.ghostRefs);
  EXPECT_EQ(a.neighbourOffsets, b.neighbourOffsets);
  EXPECT_EQ(a.neighbours, b.neighbours);
  EXPECT_EQ(a.alphaCounts, b.alphaCounts);
  EXPECT_EQ(a.densities, b.densities);
  EXPECT_EQ(a.orientations, b.orientations);
  EXPECT_EQ(a.cellColours, b.cellColours);
  EXPECT_EQ(a.cellHeights, b.cellHeights);
  EXPECT_EQ(a.solidBalls, b.solidBalls);
  EXPECT_EQ(a.detailSites, b.detailSites);
  EXPECT_EQ(a.detailHeights, b.detailHeights);
  EXPECT_EQ(a.baseColours, b.baseColours);
  EXPECT_EQ(a.detailScales, b.detailScales);
  EXPECT_EQ(a.colourScales, b.colourScales);
  EXPECT_EQ(a.lobeCounts, b.lobeCounts);
  EXPECT_EQ(a.lobeAxes, b.lobeAxes);
  EXPECT_EQ(a.lobeColours, b.lobeColours);
}

void expectSameBake(const BakeResult& a, const BakeResult& b) {
  EXPECT_EQ(a.sourceCells, b.sourceCells);
  EXPECT_EQ(a.contents.axisCodebook, b.contents.axisCodebook);
  EXPECT_EQ(a.contents.psnr, b.contents.psnr);
  ASSERT_EQ(a.contents.errors.size(), b.contents.errors.size());
  for (size_t k = 0; k < a.contents.errors.size(); ++k) EXPECT_EQ(a.contents.errors[k].rms, b.contents.errors[k].rms);
  ASSERT_EQ(a.contents.chunks.size(), b.contents.chunks.size());
  for (size_t k = 0; k < a.contents.chunks.size(); ++k) expectSameChunk(a.contents.chunks[k], b.contents.chunks[k]);
}

TEST(Determinism, ThreadsDoNotMatter) {
  const Foam foam = makeRandomFoam(1500, 2, 2, 4);
  BakeOptions options;
  options.chunkCells = 400;
  for (const char* preset : {"exact", "default"}) {
    options.preset = preset;
    options.knobs = *presetKnobs(preset);
    const BakeResult one = bake(foam, options, 1);
    expectSameBake(one, bake(foam, options, 2));
    expectSameBake(one, bake(foam, options, 8));
    expectSameBake(one, bake(foam, options, 1));
  }
}

TEST(Determinism, ThreadsDoNotMatterToARegionOfEyes) {
  const Foam foam = makeRandomFoam(300, 2, 2, 4);
  BakeOptions options;
  options.preset = "default";
  options.knobs = *presetKnobs("default");
  CameraSet cameras;
  View& view = cameras.views.emplace_back();  // from (0, 0, -4) along z
  view.width = view.height = 48;
  view.fx = view.fy = view.cx = view.cy = 24;
  view.worldFromCamera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -4};
  options.cameras = &cameras;
  options.eyes.aroundCameras = 1;
  const BakeResult one = bake(foam, options, 1);
  EXPECT_GT(one.contents.eyes.meanPsnr, 0);
  const BakeResult many = bake(foam, options, 8);
  expectSameBake(one, many);
  EXPECT_EQ(one.contents.eyes.meanPsnr, many.contents.eyes.meanPsnr);
  EXPECT_EQ(one.contents.eyes.worstPsnr, many.contents.eyes.worstPsnr);
}

TEST(Determinism, AMemoryLimitDoesNotMatter) {
  const Foam foam = makeRandomFoam(3000, 1, 2, 4);
  BakeOptions options;
  const BakeResult whole = bake(foam, options, 2);
  options.memoryLimit = 2 << 20;  // too little for one piece
  expectSameBake(whole, bake(foam, options, 2));
}

}  // namespace
}  // namespace froth
