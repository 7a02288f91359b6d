// Objects made and destroyed over and over.
#include "runtime_fixture.h"

namespace froth {
namespace {

constexpr uint32_t kCycles = 100000, kDeviceCycles = 1000;

class Cycles : public RuntimeTest {};

TEST_F(Cycles, OfAllObjectsOnANullContextLeaveNothingBehind) {
  createContext();
  const std::vector<uint8_t> bytes = encodeSample();
  auto assetInfo = makeStruct<FrothAssetInfo>();
  assetInfo.data = bytes.data();
  assetInfo.dataSize = bytes.size();
  for (uint32_t cycle = 1; cycle <= kCycles; ++cycle) {
    FrothAsset asset{};
    ASSERT_EQ(frothOpenAsset(context_, &assetInfo, &asset), FROTH_OK);
    const FrothInstance instance = createInstance(asset);
    const FrothView view = createView({8, 8});
    ASSERT_EQ(update(cycle), FROTH_OK);
    ASSERT_EQ(asset.index + instance.index + view.index, 0u) << "places are used again";
    ASSERT_EQ(asset.generation, cycle);
    ASSERT_EQ(frothDestroyView(context_, view), FROTH_OK);
    ASSERT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
    ASSERT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  }
  EXPECT_THAT(messages_, ::testing::IsEmpty());
}

TEST_F(Cycles, OfNullContextsLeaveNothingBehind) {
  for (uint32_t cycle = 0; cycle < kCycles; ++cycle) {
    createContext();
    openBytes({1, 2, 3});
    ASSERT_EQ(frothDestroyContext(context_, 0), FROTH_OK);
    context_ = nullptr;
  }
}

class CyclesOnDevice : public RuntimeGpuTest {};

TEST_F(CyclesOnDevice, OfAllObjectsGiveAllMemoryBack) {
  createContext(host_->contextInfo());
  const std::vector<uint8_t> bytes = encodeSample();
  auto assetInfo = makeStruct<FrothAssetInfo>();
  assetInfo.data = bytes.data();
  assetInfo.dataSize = bytes.size();
  for (uint32_t cycle = 0; cycle < kDeviceCycles; ++cycle) {
    FrothAsset asset{};
    ASSERT_EQ(frothOpenAsset(context_, &assetInfo, &asset), FROTH_OK);
    const FrothInstance instance = createInstance(asset);
    const FrothView view = createView({8, 8});
    runFrame();
    ASSERT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
    ASSERT_EQ(frothDestroyView(context_, view), FROTH_OK);
    ASSERT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
    ASSERT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  }
  runFrame();
  auto report = makeStruct<FrothMemoryReport>();
  ASSERT_EQ(frothGetMemoryReport(context_, &report), FROTH_OK);
  EXPECT_EQ(report.deviceBytes, 0u);
  EXPECT_EQ(report.categories[2].granted, 0u);
  EXPECT_EQ(report.categories[3].used, 0u);
}

}  // namespace
}  // namespace froth
