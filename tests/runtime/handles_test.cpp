#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

class Handles : public RuntimeTest {
 protected:
  void SetUp() override {
    createContext();
    bytes_ = encodeSample();
  }

  std::vector<uint8_t> bytes_;
};

TEST_F(Handles, OfZeroAreNull) {
  auto status = makeStruct<FrothAssetStatus>();
  auto viewStatus = makeStruct<FrothViewStatus>();
  EXPECT_EQ(frothGetAssetStatus(context_, FrothAsset{}, &status), FROTH_ERROR_HANDLE);
  EXPECT_EQ(frothGetViewStatus(context_, FrothView{}, &viewStatus), FROTH_ERROR_HANDLE);
  EXPECT_EQ(frothDestroyInstance(context_, FrothInstance{}), FROTH_ERROR_HANDLE);
  openBytes(bytes_);
  EXPECT_EQ(frothGetAssetStatus(context_, FrothAsset{}, &status), FROTH_ERROR_HANDLE);
}

TEST_F(Handles, AreNullAfterACallThatFailed) {
  auto info = makeStruct<FrothViewInfo>();  // no extent
  FrothView view{7, 7};
  EXPECT_EQ(frothCreateView(context_, &info, &view), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(view.generation, 0u);
  FrothInstance instance{7, 7};
  EXPECT_EQ(frothCreateInstance(context_, nullptr, &instance), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(instance.generation, 0u);
}

TEST_F(Handles, OfAClosedAssetStayStaleWhenItsPlaceIsTakenAgain) {
  const FrothAsset first = openBytes(bytes_);
  ASSERT_EQ(frothCloseAsset(context_, first), FROTH_OK);
  const FrothAsset second = openBytes(bytes_);
  EXPECT_EQ(first.index, second.index);
  EXPECT_NE(first.generation, second.generation);
  auto status = makeStruct<FrothAssetStatus>();
  EXPECT_EQ(frothGetAssetStatus(context_, first, &status), FROTH_ERROR_HANDLE);
  EXPECT_EQ(frothCloseAsset(context_, first), FROTH_ERROR_HANDLE);
  EXPECT_EQ(statusOf(second).state, FROTH_ASSET_OPENING);
  auto info = makeStruct<FrothInstanceInfo>();
  info.asset = first;
  FrothInstance instance{};
  EXPECT_EQ(frothCreateInstance(context_, &info, &instance), FROTH_ERROR_HANDLE);
}

TEST_F(Handles, OfADestroyedViewAreStaleInRecordCalls) {
  const FrothView view = createView({8, 8});
  ASSERT_EQ(frothDestroyView(context_, view), FROTH_OK);
  const auto info = makeStruct<FrothRenderInfo>();
  EXPECT_EQ(frothRecordRaster(context_, view, nullptr, &info), FROTH_ERROR_HANDLE);
  EXPECT_EQ(frothRecordWalk(context_, view, nullptr, &info), FROTH_ERROR_HANDLE);
  EXPECT_THAT(lastText(), HasSubstr("destroyed or never created"));
}

TEST_F(Handles, OfAnAssetStayWhileInstancesUseIt) {
  const FrothAsset asset = openBytes(bytes_);
  const FrothInstance instance = createInstance(asset);
  EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_ERROR_STATE);
  EXPECT_THAT(lastText(), HasSubstr("1 instances still use it"));
  ASSERT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
  EXPECT_EQ(frothDestroyInstance(context_, instance), FROTH_ERROR_HANDLE);
  EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
}

TEST_F(Handles, OfInstancesRefuseWhatIsNoSimilarity) {
  auto info = makeStruct<FrothInstanceInfo>();
  info.asset = openBytes(bytes_);
  FrothInstance instance{};
  info.scale = -2;
  EXPECT_EQ(frothCreateInstance(context_, &info, &instance), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("scale: -2"));
  info.scale = 2;
  info.exposure = -1;
  EXPECT_EQ(frothCreateInstance(context_, &info, &instance), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("exposure: -1"));
  info.exposure = 0;
  info.rotation[0] = 1;
  info.rotation[3] = 1;
  EXPECT_EQ(frothCreateInstance(context_, &info, &instance), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("squared length 2"));
  info.rotation[0] = 0;
  EXPECT_EQ(frothCreateInstance(context_, &info, &instance), FROTH_OK);
  info.position[1] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(frothSetInstance(context_, instance, &info), FROTH_ERROR_ARGUMENT);
}

TEST_F(Handles, OfViewsNeedAnExtentWithinTheLimit) {
  auto info = makeStruct<FrothViewInfo>();
  FrothView view{};
  EXPECT_EQ(frothCreateView(context_, &info, &view), FROTH_ERROR_ARGUMENT);
  info.maxExtent = {16385, 1};
  EXPECT_EQ(frothCreateView(context_, &info, &view), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("16385 x 1"));
}

}  // namespace
}  // namespace froth
