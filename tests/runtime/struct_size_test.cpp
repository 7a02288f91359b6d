#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;
using ::testing::IsNull;

class StructSize : public RuntimeTest {};

// A caller compiled with a newer header: known fields, then some that this library does not know.
template <class T>
struct Newer {
  T known{};
  uint64_t unknown = 0;
};

TEST_F(StructSize, MustBeSet) {
  FrothContextInfo info{};
  info.abiVersion = FROTH_ABI_VERSION;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_ARGUMENT);
  createContext();
  FrothViewInfo viewInfo{};
  FrothView view{};
  EXPECT_EQ(frothCreateView(context_, &viewInfo, &view), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("structSize: 0"));
}

TEST_F(StructSize, OfANewerCallerIsAcceptedWhileTheUnknownFieldsAreZero) {
  createContext();
  Newer<FrothViewInfo> info;
  info.known.structSize = sizeof(info);
  info.known.maxExtent = {4, 4};
  FrothView view{};
  EXPECT_EQ(frothCreateView(context_, &info.known, &view), FROTH_OK);
  info.unknown = 1;
  EXPECT_EQ(frothCreateView(context_, &info.known, &view), FROTH_ERROR_VERSION);
  EXPECT_THAT(lastText(), HasSubstr("fields beyond are not zero"));
}

TEST_F(StructSize, OfAnOlderCallerLeavesTheRestAtItsDefault) {
  createContext();
  const FrothAsset asset = openBytes(encodeSample());
  auto info = makeStruct<FrothInstanceInfo>();
  info.structSize = offsetof(FrothInstanceInfo, scale);  // an older header that ends before `scale`
  info.asset = asset;
  info.scale = -1;  // would be refused, if it were read
  FrothInstance instance{};
  EXPECT_EQ(frothCreateInstance(context_, &info, &instance), FROTH_OK) << lastText();
}

TEST_F(StructSize, OfAnOlderCallersResultIsNotOverrun) {
  createContext();
  const FrothAsset asset = openBytes(encodeSample());
  ASSERT_EQ(update(1), FROTH_OK);
  FrothAssetStatus status;
  std::memset(&status, 0x5a, sizeof(status));
  status.structSize = offsetof(FrothAssetStatus, liveCount);
  ASSERT_EQ(frothGetAssetStatus(context_, asset, &status), FROTH_OK);
  EXPECT_EQ(status.structSize, offsetof(FrothAssetStatus, liveCount));
  EXPECT_EQ(status.cellCount, 6u);
  EXPECT_EQ(status.liveCount, 0x5a5a5a5au);
}

TEST_F(StructSize, OfANewerCallersResultIsFilledUpWithZeros) {
  createContext();
  Newer<FrothAssetStatus> status;
  status.unknown = 7;
  status.known.structSize = sizeof(status);
  ASSERT_EQ(frothGetAssetStatus(context_, openBytes(encodeSample()), &status.known), FROTH_OK);
  EXPECT_EQ(status.unknown, 0u);
}

TEST_F(StructSize, AndVersionOfTheHeaderMustFit) {
  FrothContextInfo info = nullContextInfo();
  info.abiVersion = FROTH_ABI_VERSION + 0x00010000;
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_VERSION);
  EXPECT_THAT(context_, IsNull());
  EXPECT_THAT(lastText(), HasSubstr("0x00020000"));
  info.abiVersion = FROTH_ABI_VERSION + 1;  // a newer minor version asks for nothing that is missing
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_OK);
}

TEST_F(StructSize, NullPointersAreNamedAndDoNotCrash) {
  createContext();
  FrothAsset asset{};
  EXPECT_EQ(frothCreateContext(nullptr, nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothOpenAsset(nullptr, nullptr, nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothOpenAsset(context_, nullptr, &asset), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothGetAssetStatus(context_, openBytes(encodeSample()), nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothUpdate(context_, nullptr, nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(lastText(), "frame: null");
  EXPECT_EQ(frothRecordRaster(context_, createView({4, 4}), nullptr, nullptr), FROTH_ERROR_ARGUMENT);
  auto info = makeStruct<FrothViewInfo>();
  info.maxExtent = {4, 4};
  EXPECT_EQ(frothCreateView(context_, &info, nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(lastText(), "view: null");
  frothDestroyContext(nullptr, UINT64_MAX);
}

TEST(ResultName, IsNeverNull) {
  EXPECT_STREQ(frothResultName(FROTH_ERROR_HANDLE), "FROTH_ERROR_HANDLE");
  EXPECT_STREQ(frothResultName(static_cast<FrothResult>(12345)), "unknown FrothResult");
}

}  // namespace
}  // namespace froth
