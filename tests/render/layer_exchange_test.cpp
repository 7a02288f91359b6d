// What happens while an asset is exchanged for one of other layers.
#include <cstring>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "format/write/asset_writer.h"
#include "froth/froth_query.h"
#include "froth/froth_reader.h"
#include "host/make_struct.h"
#include "tests/render/layer_scene.h"
#include "tests/render/random_foam.h"

namespace froth::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class LayerExchange : public LayerScene {
 protected:
  // The exchange for two layers has begun: its jobs wait.
  FrothAsset beginExchange() {
    const FrothAsset asset = open();
    drawUntilSteady();
    jobs_.areHeld = true;
    setBudget(budgetFor(2));
    for (int frame = 0; frame < 20 && jobs_.held.empty(); ++frame) draw();
    EXPECT_FALSE(jobs_.held.empty());
    return asset;
  }

  // Its chunks too are under way.
  FrothAsset beginDecoding() {
    const FrothAsset asset = beginExchange();
    jobs_.runAll();
    draw();
    EXPECT_FALSE(jobs_.held.empty());
    return asset;
  }

  void releaseJobs() {
    jobs_.areHeld = false;
    jobs_.runAll();
  }
};

TEST_F(LayerExchange, SurvivesDroppedFramesAndNeverLeavesTheAssetOut) {
  const FrothAsset asset = open();
  drawUntilSteady();
  setBudget(budgetFor(2));
  for (int frame = 0; frame < 40 && layersOf(asset) == 3; ++frame) {
    draw();
    drop();  // with whatever it uploads
    EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY) << "frame " << frame;
  }
  drawUntilLayers(asset, 2);
  drop();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_EQ(drawUntilSteady().texels, alone(2).texels);
}

TEST_F(LayerExchange, OfAClosedAssetEndsAndLeavesNothingBehind) {
  const FrothAsset asset = beginDecoding();
  close(asset);
  releaseJobs();
  for (int frame = 0; frame < 5; ++frame) draw();
  EXPECT_EQ(report().categories[0].granted, 0u);
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(LayerExchange, OfADestroyedContextEnds) {
  beginDecoding();
  ASSERT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  context_ = nullptr;
  releaseJobs();
}

TEST_F(LayerExchange, EndsWithTheDeviceAndTheAssetComesBackAsItWas) {
  const FrothAsset asset = beginDecoding();
  ASSERT_EQ(vkDeviceWaitIdle(sharedHost().device), VK_SUCCESS);
  ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
  releaseJobs();
  restoreDevice();
  const Shown shown = drawUntilSteady();
  EXPECT_EQ(layersOf(asset), 3u);
  EXPECT_EQ(shown.texels, alone(3).texels);
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(LayerExchange, LeavesLayersToReturnOnANewDevice) {
  const FrothAsset asset = open();
  drawUntilSteady();
  setBudget(budgetFor(2));
  drawUntilLayers(asset, 2);
  ASSERT_EQ(vkDeviceWaitIdle(sharedHost().device), VK_SUCCESS);
  ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
  restoreDevice();  // without a budget
  EXPECT_EQ(drawUntilSteady().texels, alone(3).texels);
  EXPECT_EQ(layersOf(asset), 3u);
}

TEST_F(LayerExchange, EndsWhereTheBudgetIsRaisedAgain) {
  const FrothAsset asset = beginDecoding();
  const uint64_t before = statusOf(asset).deviceBytes;
  setBudget(0);
  draw();
  releaseJobs();
  const Shown shown = drawUntilSteady();
  EXPECT_EQ(layersOf(asset), 3u);
  EXPECT_EQ(shown.texels, alone(3).texels);
  EXPECT_EQ(shown.result, FROTH_OK);
  EXPECT_EQ(report().categories[0].granted, before);
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(LayerExchange, ThatBringsLayersBackEndsWhereTheBudgetFalls) {
  const FrothAsset asset = open();
  drawUntilSteady();
  const uint64_t low = budgetFor(2);
  setBudget(low);
  drawUntilLayers(asset, 2);
  drawUntilSteady();
  jobs_.areHeld = true;
  setBudget(0);
  for (int frame = 0; frame < 20 && jobs_.held.empty(); ++frame) draw();
  ASSERT_FALSE(jobs_.held.empty());
  setBudget(low);
  draw();
  releaseJobs();
  const Shown shown = drawUntilSteady();
  EXPECT_EQ(layersOf(asset), 2u);
  EXPECT_EQ(shown.texels, alone(2).texels);
  EXPECT_EQ(shown.frame.excessBytes, 0u);
  EXPECT_THAT(warnings(), SizeIs(1)) << "of the first fall alone";
}

TEST_F(LayerExchange, ThatFailsLeavesTheAssetAndTellsOnce) {
  const FrothAsset asset = open();
  drawUntilSteady();
  std::filesystem::remove(path());
  setBudget(budgetOfFewerCells());
  const Shown shown = drawUntilSteady();
  drawUntilSteady();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_EQ(layersOf(asset), 3u);
  EXPECT_EQ(shown.frame.excessBytes, 0u);
  EXPECT_NE(viewStatus().bits & FROTH_VIEW_CELL_OVERFLOW, 0u) << "cells go instead";
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("scene.froth: it keeps its layers, for it did not load once more: ")));
}

TEST_F(LayerExchange, RefusesAnotherSceneInTheFile) {
  const FrothAsset asset = open();
  drawUntilSteady();
  const std::vector<uint8_t> other = *encodeAsset(bakeForTest(makeRandomFoam(50, 2, 1, 3)));
  std::ofstream(path(), std::ios::binary).write(reinterpret_cast<const char*>(other.data()), std::ssize(other));
  setBudget(budgetOfFewerCells());
  drawUntilSteady();
  EXPECT_EQ(layersOf(asset), 3u);
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("it is another scene; close it and open it again")));
}

TEST_F(LayerExchange, IsNotForBytesThatMayBeGone) {
  auto info = makeStruct<FrothAssetInfo>();
  info.data = bytes().data();
  info.dataSize = bytes().size();
  const FrothAsset kept = open(info);
  drawUntilSteady();
  setBudget(budgetOfFewerCells());
  EXPECT_EQ(drawUntilSteady().frame.excessBytes, 0u);
  EXPECT_EQ(layersOf(kept), 3u);
  EXPECT_NE(viewStatus().bits & FROTH_VIEW_CELL_OVERFLOW, 0u);
  EXPECT_THAT(warnings(), IsEmpty());
  close(kept);
  info.bytesStay = 1;
  setBudget(0);
  const FrothAsset asset = open(info);
  drawUntilSteady();
  setBudget(budgetFor(2));
  drawUntilLayers(asset, 2);
}

TEST_F(LayerExchange, AsksAReaderAgain) {
  struct Pack {
    FrothContext* context;
    int reads = 0;
  } pack{context_};
  auto reader = makeStruct<FrothReader>();
  reader.user = &pack;
  reader.size = bytes().size();
  reader.read = [](void* user, uint64_t request, uint64_t offset, uint64_t size, void* destination) {
    Pack& asked = *static_cast<Pack*>(user);
    ++asked.reads;
    std::memcpy(destination, bytes().data() + offset, size);
    check(frothCompleteRead(asked.context, request, FROTH_OK), "frothCompleteRead");
  };
  auto info = makeStruct<FrothAssetInfo>();
  info.reader = &reader;
  const FrothAsset asset = open(info);
  drawUntilSteady();
  const int reads = pack.reads;
  setBudget(budgetFor(2));
  drawUntilLayers(asset, 2);
  EXPECT_GT(pack.reads, reads);
  EXPECT_EQ(drawUntilSteady().texels, alone(2).texels);
}

TEST_F(LayerExchange, LeavesQueriesAsTheyAre) {
  const FrothAsset asset = open();
  drawUntilSteady();
  const auto ask = [&] {
    FrothRay ray{};
    ray.direction[2] = 1;
    auto cast = makeStruct<FrothCastInfo>();
    FrothRayHit hit{};
    check(frothCastRays(context_, &cast, &ray, &hit, 1), "frothCastRays");
    return hit;
  };
  const FrothRayHit before = ask();
  const uint64_t hostBytes = statusOf(asset).hostBytes;
  EXPECT_LT(before.transmittance, 1);
  setBudget(budgetFor(2));
  for (int frame = 0; frame < 40 && layersOf(asset) == 3; ++frame) {
    draw();
    EXPECT_EQ(ask().transmittance, before.transmittance);
  }
  EXPECT_EQ(layersOf(asset), 2u);
  EXPECT_EQ(statusOf(asset).hostBytes, hostBytes);
}

}  // namespace
}  // namespace froth::test
