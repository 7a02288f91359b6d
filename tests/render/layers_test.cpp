// Layers of assets go where the budget is short, before cells do, and return where there is room.
#include <algorithm>

#include <gmock/gmock.h>

#include "format/write/asset_writer.h"
#include "host/make_struct.h"
#include "tests/render/layer_scene.h"
#include "tests/render/random_foam.h"

namespace froth::test {
namespace {

using ::testing::ElementsAre;

using ::testing::HasSubstr;
using ::testing::Pair;

class Layers : public LayerScene {};

TEST_F(Layers, GoBeforeCellsAndReturnBitForBit) {
  const FrothAsset asset = open();
  const Shown whole = drawUntilSteady();
  ASSERT_EQ(whole.texels, alone(3).texels);
  ASSERT_NE(alone(2).texels, alone(3).texels);
  ASSERT_NE(alone(1).texels, alone(2).texels);
  EXPECT_EQ(layersOf(asset), 3u);
  const uint64_t all = report().deviceBytes;
  // The view holds space for all cells, and sees less than half of them: it lacks none before it has given up as much.
  const uint64_t spare = viewBytes() * 45 / 100;
  for (const uint32_t layers : {2u, 1u}) {
    const uint64_t budget = budgetFor(layers, all) - (layers == 1 ? spare : 0);
    setBudget(budget);
    drawUntilLayers(asset, layers);
    const Shown steady = drawUntilSteady();
    EXPECT_EQ(layersOf(asset), layers) << "no more than must go";
    EXPECT_EQ(steady.texels, alone(layers).texels) << layers << " layers, all cells";
    EXPECT_EQ(steady.result, FROTH_INCOMPLETE);
    EXPECT_EQ(viewStatus().bits, uint32_t{FROTH_VIEW_FEWER_LAYERS});
    EXPECT_LE(steady.frame.deviceBytes, budget);
    EXPECT_EQ(statusOf(asset).deviceBytes, alone(layers).bytes);
    ASSERT_EQ(warnings().size(), 3 - layers);
    EXPECT_THAT(warnings().back(), HasSubstr("scene.froth: layers: " + std::to_string(layers) + " instead of " +
                                             std::to_string(layers + 1)));
  }
  setBudget(report().deviceBytes - viewBytes() / 8);
  const Shown least = drawUntilSteady();
  EXPECT_NE(viewStatus().bits & FROTH_VIEW_CELL_OVERFLOW, 0u) << "then cells";
  EXPECT_EQ(least.frame.excessBytes, 0u);
  EXPECT_EQ(warnings().size(), 2u);

  setBudget(0);
  drawUntilLayers(asset, 2);
  drawUntilLayers(asset, 3);
  const Shown again = drawUntilSteady();
  EXPECT_EQ(again.texels, whole.texels);
  EXPECT_EQ(again.result, FROTH_OK);
  EXPECT_EQ(warnings().size(), 2u) << "what returns needs no warning";
}

TEST_F(Layers, OfViewDependenceGoFromAllAssetsBeforeAnyDetailAndOneByOne) {
  const FrothAsset first = open(), second = open();
  drawUntilSteady();
  const uint64_t little = 2 * alone(1).bytes + viewBytes() / 4;
  std::vector<std::pair<uint32_t, uint32_t>> steps{{3, 3}};
  const auto follow = [&](uint32_t layers) {
    for (int frame = 0; frame < 80 && steps.back() != std::pair(layers, layers); ++frame) {
      draw();
      const std::pair now(layersOf(first), layersOf(second));
      if (now != steps.back()) steps.push_back(now);
    }
  };
  setBudget(little);
  follow(1);
  setBudget(0);
  follow(3);
  EXPECT_THAT(steps, ElementsAre(Pair(3, 3), Pair(2, 3), Pair(2, 2), Pair(1, 2), Pair(1, 1), Pair(2, 1), Pair(2, 2),
                                 Pair(3, 2), Pair(3, 3)));
}

// With frames in flight, as an engine has them.
TEST_F(Layers, ExceedTheBudgetByTheSmallerAssetAtMostAndThenRest) {
  const FrothAsset asset = open();
  drawUntilSteady();
  lag_ = 3;
  for (int frame = 0; frame < 3; ++frame) draw();
  const uint64_t before = report().deviceBytes, budget = budgetFor(2);
  setBudget(budget);
  uint32_t exchanges = 0;
  for (int frame = 0, layers = 3; frame < 100; ++frame) {
    const Shown shown = draw();
    EXPECT_LE(shown.frame.deviceBytes, before + alone(2).bytes) << "frame " << frame;
    exchanges += layersOf(asset) != static_cast<uint32_t>(layers);
    layers = static_cast<int>(layersOf(asset));
  }
  EXPECT_EQ(layersOf(asset), 2u);
  EXPECT_EQ(exchanges, 1u) << "to and fro";
  EXPECT_LE(report().deviceBytes, budget);
  EXPECT_EQ(draw().texels, alone(2).texels);
}

TEST_F(Layers, AreThoseOfTheFile) {
  Foam foam = makeRandomFoam(300, 3, 0, 6);
  const std::vector<uint8_t> bytes = *encodeAsset(bakeForTest(foam));
  auto info = makeStruct<FrothAssetInfo>();
  info.data = bytes.data();
  info.dataSize = bytes.size();
  info.bytesStay = 1;
  const FrothAsset asset = open(info);
  EXPECT_EQ(layersOf(asset), 2u) << "it has no view dependence";
  EXPECT_EQ(drawUntilSteady().result, FROTH_OK);
  setBudget(1);
  for (int frame = 0; frame < 40 && layersOf(asset) == 2; ++frame) draw();
  EXPECT_EQ(layersOf(asset), 1u);
  setBudget(0);
  for (int frame = 0; frame < 40 && layersOf(asset) == 1; ++frame) draw();
  EXPECT_EQ(layersOf(asset), 2u);
  EXPECT_EQ(drawUntilSteady().result, FROTH_OK);
  close(asset);
}

}  // namespace
}  // namespace froth::test
