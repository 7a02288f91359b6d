// Pipelines in jobs of the caller, and ahead of time: froth_precompile.h.
#include <thread>

#include "froth/froth_pool.h"
#include "jobs_fixture.h"

namespace froth {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST_F(Jobs, MakePipelinesInNoFrame) {
  createWith(HeldJobs::hold, &jobs_);
  const FrothAsset asset = openBytes(bytes_);
  createInstance(asset);
  createInstance(asset);
  const FrothView view = createView(kJobsExtent);
  for (int frame = 0; frame < 100 && (statusOf(asset).state != FROTH_ASSET_READY || !jobs_.held.empty()); ++frame) {
    std::thread([&] { jobs_.runAll(); }).join();
    runFrame();
  }
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_EQ(pipelinesMadeHere, 0);
  EXPECT_GT(pipelinesMadeElsewhere, 10);
  draw(view);  // both instances: OK
}

TEST_F(Jobs, ASecondInstanceIsNotDrawnBeforeItsPipelinesAreThere) {
  createWith(HeldJobs::hold, &jobs_);
  const FrothAsset asset = openBytes(bytes_);
  createInstance(asset);
  const FrothView view = createView(kJobsExtent);
  for (int frame = 0; frame < 100 && statusOf(asset).state != FROTH_ASSET_READY; ++frame) {
    jobs_.runAll();
    runFrame();
  }
  const auto settle = [&] {
    do {
      jobs_.runAll();
      runFrame();
    } while (!jobs_.held.empty());
  };
  settle();
  const std::vector<float> alone = draw(view);
  createInstance(asset);
  EXPECT_EQ(draw(view, FROTH_INCOMPLETE), alone);
  settle();
  EXPECT_NE(draw(view), alone);  // twice as dense
}

TEST_F(Jobs, ThatMakePipelinesLeaveTheirRoomToOthers) {
  createWith(HeldJobs::hold, &jobs_, 1);
  const auto load = [&](FrothAsset asset) {
    for (int frame = 0; frame < 100 && statusOf(asset).state == FROTH_ASSET_OPENING; ++frame) {
      jobs_.runAll();
      runFrame();
    }
    EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  };
  for (uint32_t details = 1; details <= 3; ++details) load(openBytes(encodeSample({.detailCount = details})));
  const FrothAsset closed = openBytes(encodeSample({.detailCount = 4}));
  runFrame();
  jobs_.runAll();  // the head
  runFrame();      // gives the job of its pipelines
  EXPECT_EQ(frothCloseAsset(context_, closed), FROTH_OK);
  load(openBytes(encodeSample({.detailCount = 5})));
}

TEST_F(Jobs, PrecompiledVariantsLeaveNothingToMake) {
  createWith(nullptr, nullptr);
  const FrothVariant variants[2] = {variantOf(bytes_), variantOf(encodeSample({.cellsPerChunk = 9, .detailCount = 2}))};
  EXPECT_NE(std::memcmp(&variants[0], &variants[1], sizeof(FrothVariant)), 0);
  std::vector<uint32_t> progress;
  auto info = makeStruct<FrothPrecompileInfo>();
  info.variants = variants;
  info.variantCount = 2;
  info.severalInstances = 1;
  info.onProgress = [](void* user, uint32_t done, uint32_t total) {
    EXPECT_EQ(total, 3u);
    static_cast<std::vector<uint32_t>*>(user)->push_back(done);
  };
  info.progressUser = &progress;
  EXPECT_EQ(frothPrecompile(context_, &info), FROTH_OK) << lastText();
  EXPECT_THAT(progress, ElementsAre(0, 1, 2, 3));
  EXPECT_GT(pipelinesMadeHere, 20);
  pipelinesMadeHere = 0;
  const FrothAsset asset = openBytes(bytes_);
  createInstance(asset);
  createInstance(asset);
  runFrame();
  runFrame();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_EQ(frothPrecompile(context_, &info), FROTH_OK);
  EXPECT_EQ(pipelinesMadeHere, 0);
}

TEST_F(Jobs, PrecompileRunsBesideFramesAndJobs) {
  FrothJobPool* pool = nullptr;
  ASSERT_EQ(frothCreateJobPool(1, &pool), FROTH_OK);
  createWith(frothRunInPool, pool);
  const FrothVariant variant = variantOf(bytes_);
  const FrothAsset asset = openBytes(bytes_);
  createInstance(asset);
  createInstance(asset);
  std::thread precompiler([&] {
    auto info = makeStruct<FrothPrecompileInfo>();
    info.variants = &variant;
    info.variantCount = 1;
    info.severalInstances = 1;
    EXPECT_EQ(frothPrecompile(context_, &info), FROTH_OK);
  });
  while (statusOf(asset).state == FROTH_ASSET_OPENING) runFrame();
  precompiler.join();
  const int made = pipelinesMadeElsewhere;
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_EQ(pipelinesMadeHere, 0);
  auto info = makeStruct<FrothPrecompileInfo>();
  info.variants = &variant;
  info.variantCount = 1;
  info.severalInstances = 1;
  EXPECT_EQ(frothPrecompile(context_, &info), FROTH_OK);
  EXPECT_EQ(pipelinesMadeElsewhere, made);  // nobody made the same ones twice, or left some out
  frothDestroyContext(context_, UINT64_MAX);
  context_ = nullptr;
  frothDestroyJobPool(pool);
}

TEST_F(Jobs, VariantsOfBadFilesAndForeignOnesAreRefused) {
  createWith(nullptr, nullptr);
  auto info = makeStruct<FrothAssetInfo>();
  info.path = "/nowhere/scene.froth";
  FrothVariant variant{{9}};
  EXPECT_EQ(frothReadVariant(context_, &info, &variant), FROTH_ERROR_FILE);
  EXPECT_THAT(lastText(), HasSubstr("/nowhere/scene.froth"));
  EXPECT_EQ(variant.words[0], 0u);
  EXPECT_EQ(frothReadVariant(context_, &info, nullptr), FROTH_ERROR_ARGUMENT);
  auto precompile = makeStruct<FrothPrecompileInfo>();
  precompile.variantCount = 1;
  EXPECT_EQ(frothPrecompile(context_, &precompile), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("variants: null"));
  for (const FrothVariant& foreign : {FrothVariant{}, FrothVariant{{3, 2, 0, 1}}, FrothVariant{{3, 2, 7}}}) {
    precompile.variants = &foreign;
    EXPECT_EQ(frothPrecompile(context_, &precompile), FROTH_ERROR_ARGUMENT);
    EXPECT_THAT(lastText(), HasSubstr("variants[0]"));
  }
}

}  // namespace
}  // namespace froth
