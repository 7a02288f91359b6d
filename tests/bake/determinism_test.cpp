// The same foam and options give the same chunks: on any number of threads, a second time, with any memory limit.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "baker/bake/bake.h"
#include "tests/bake/random_foam.h"
#include "tests/bake/same_bake.h"

namespace froth {
namespace {

BakeResult bake(const Foam& foam, const BakeOptions& options, size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  Result<BakeResult> result = bakeFoam(foam, options);
  EXPECT_TRUE(result) << result.error().message;
  return std::move(*result);
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
