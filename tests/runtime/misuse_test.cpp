// Every call with every struct of a wrong size, and with every handle stale.
#include <cstdlib>

#include "froth/froth_stream.h"
#include "froth/froth_walk.h"
#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

class Misuse : public RuntimeTest {
 protected:
  void SetUp() override {
    createContext();
    asset_ = openBytes(encodeSample());
    instance_ = createInstance(asset_);
    view_ = createView({8, 8});
    ASSERT_EQ(update(1), FROTH_OK);
  }

  FrothAsset asset_{};
  FrothInstance instance_{};
  FrothView view_{};
};

// A block of exactly `size` bytes, so that the sanitizer sees every byte beyond it that is touched.
template <class T>
struct Block {
  Block(uint32_t structSize, size_t size, unsigned char fill) : bytes(static_cast<unsigned char*>(std::malloc(size))) {
    std::memset(bytes, fill, size);
    std::memcpy(bytes, &structSize, sizeof(structSize));
  }
  ~Block() { std::free(bytes); }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
  T* get() { return reinterpret_cast<T*>(bytes); }

  unsigned char* bytes;
};

// What goes in: `call` gets a struct and returns the result.
template <class T, class Call>
void expectInputSizes(const char* name, Call call) {
  SCOPED_TRACE(name);
  for (const uint32_t unset : {0u, 3u, 0xcdcdcdcdu}) {
    EXPECT_EQ(call(Block<T>(unset, sizeof(T), 0).get()), FROTH_ERROR_ARGUMENT) << unset;
  }
  Block<T> newer(sizeof(T) + 8, sizeof(T) + 8, 0);
  const FrothResult ofZeros = call(newer.get());
  EXPECT_NE(ofZeros, FROTH_ERROR_VERSION) << "a tail of zeros asks for nothing";
  newer.bytes[sizeof(T) + 7] = 1;
  EXPECT_EQ(call(newer.get()), FROTH_ERROR_VERSION);
  for (uint32_t size = 4; size < sizeof(T); size += 4) {  // older: reads no byte beyond
    EXPECT_NE(call(Block<T>(size, size, 0).get()), FROTH_ERROR_VERSION) << size;
  }
}

// What comes out: `call` must succeed with the struct, of whatever size.
template <class T, class Call>
void expectOutputSizes(const char* name, Call call) {
  SCOPED_TRACE(name);
  for (const uint32_t unset : {0u, 3u, 0xcdcdcdcdu}) {
    EXPECT_EQ(call(Block<T>(unset, sizeof(T), 0).get()), FROTH_ERROR_ARGUMENT) << unset;
  }
  Block<T> newer(sizeof(T) + 8, sizeof(T) + 8, 0x5a);
  EXPECT_GE(call(newer.get()), FROTH_OK);
  for (size_t i = 0; i < 8; ++i) EXPECT_EQ(newer.bytes[sizeof(T) + i], 0) << "what is unknown becomes zero";
  for (uint32_t size = 4; size < sizeof(T); size += 4) {
    EXPECT_GE(call(Block<T>(size, size, 0x5a).get()), FROTH_OK) << size;
  }
}

TEST_F(Misuse, OfStructSizesThatGoIn) {
  expectInputSizes<FrothContextInfo>("frothCreateContext", [](auto* info) {
    if (info->structSize == sizeof(uint32_t)) return FROTH_OK;  // too old to tell its version
    info->abiVersion = FROTH_ABI_VERSION;
    FrothContext* made = nullptr;
    const FrothResult result = frothCreateContext(info, &made);
    EXPECT_EQ(frothDestroyContext(made, UINT64_MAX), FROTH_OK);
    return result;
  });
  expectInputSizes<FrothContextInfo>("frothRestoreDevice",
                                     [&](auto* info) { return frothRestoreDevice(context_, info); });
  expectInputSizes<FrothAssetInfo>("frothOpenAsset", [&](auto* info) {
    FrothAsset made{};
    return frothOpenAsset(context_, info, &made);
  });
  expectInputSizes<FrothInstanceInfo>("frothCreateInstance", [&](auto* info) {
    FrothInstance made{};
    return frothCreateInstance(context_, info, &made);
  });
  expectInputSizes<FrothInstanceInfo>("frothSetInstance",
                                      [&](auto* info) { return frothSetInstance(context_, instance_, info); });
  expectInputSizes<FrothViewInfo>("frothCreateView", [&](auto* info) {
    FrothView made{};
    return frothCreateView(context_, info, &made);
  });
  expectInputSizes<FrothFrame>("frothUpdate", [&](auto* frame) { return frothUpdate(context_, frame, nullptr); });
  expectInputSizes<FrothRenderInfo>("frothRecordRaster",
                                    [&](auto* info) { return frothRecordRaster(context_, view_, nullptr, info); });
  expectInputSizes<FrothRenderInfo>("frothRecordWalk",
                                    [&](auto* info) { return frothRecordWalk(context_, view_, nullptr, info); });
  auto contextInfo = nullContextInfo();
  contextInfo.walkShaders = 1;
  FrothContext* walking = nullptr;
  ASSERT_EQ(frothCreateContext(&contextInfo, &walking), FROTH_OK);
  expectInputSizes<FrothWalkInfo>("frothRecordWalkSet", [&](auto* info) {
    VkDescriptorSet set;
    return frothRecordWalkSet(walking, nullptr, info, &set);
  });
  EXPECT_EQ(frothDestroyContext(walking, UINT64_MAX), FROTH_OK);
  FrothRay ray{};
  ray.direction[0] = 1;
  FrothRayHit hit;
  expectInputSizes<FrothCastInfo>("frothCastRays",
                                  [&](auto* info) { return frothCastRays(context_, info, &ray, &hit, 1); });
  expectInputSizes<FrothSphere>("frothOverlapSphere", [&](auto* sphere) {
    auto contact = makeStruct<FrothContact>();
    return frothOverlapSphere(context_, sphere, &contact);
  });
}

TEST_F(Misuse, OfStructSizesThatComeOut) {
  expectOutputSizes<FrothRequirements>("frothGetRequirements", [](auto* requirements) {
    return frothGetRequirements(nullptr, VK_NULL_HANDLE, VK_NULL_HANDLE, requirements);
  });
  expectOutputSizes<FrothMemoryReport>("frothGetMemoryReport",
                                       [&](auto* report) { return frothGetMemoryReport(context_, report); });
  expectOutputSizes<FrothAssetStatus>("frothGetAssetStatus",
                                      [&](auto* status) { return frothGetAssetStatus(context_, asset_, status); });
  expectOutputSizes<FrothViewStatus>("frothGetViewStatus",
                                     [&](auto* status) { return frothGetViewStatus(context_, view_, status); });
  uint64_t serial = 1;
  expectOutputSizes<FrothFrameStatus>("frothUpdate", [&](auto* status) {
    auto frame = makeStruct<FrothFrame>();
    frame.serial = serial + 1;
    frame.completedSerial = serial;
    const FrothResult result = frothUpdate(context_, &frame, status);
    if (result == FROTH_OK) ++serial;  // a struct of a wrong size begins no frame
    return result;
  });
  const auto sphere = makeStruct<FrothSphere>();
  expectOutputSizes<FrothContact>("frothOverlapSphere",
                                  [&](auto* contact) { return frothOverlapSphere(context_, &sphere, contact); });
}

TEST_F(Misuse, OfStaleHandlesInEveryCallIsAnErrorThatNamesThem) {
  ASSERT_EQ(frothDestroyInstance(context_, instance_), FROTH_OK);
  ASSERT_EQ(frothCloseAsset(context_, asset_), FROTH_OK);
  ASSERT_EQ(frothDestroyView(context_, view_), FROTH_OK);
  auto assetStatus = makeStruct<FrothAssetStatus>();
  auto viewStatus = makeStruct<FrothViewStatus>();
  auto instanceInfo = makeStruct<FrothInstanceInfo>();
  instanceInfo.asset = asset_;
  const auto renderInfo = makeStruct<FrothRenderInfo>();
  auto location = makeStruct<FrothLocation>();
  const double point[3] = {};
  uint32_t count = 0;
  FrothInstance made{};
  const std::pair<FrothResult, const char*> results[] = {
      {frothGetAssetStatus(context_, asset_, &assetStatus), "frothGetAssetStatus"},
      {frothGetFlightPath(context_, asset_, 0, nullptr, &count), "frothGetFlightPath"},
      {frothGetChunks(context_, asset_, 0, nullptr, &count), "frothGetChunks"},
      {frothCloseAsset(context_, asset_), "frothCloseAsset"},
      {frothCreateInstance(context_, &instanceInfo, &made), "frothCreateInstance"},
      {frothSetInstance(context_, instance_, &instanceInfo), "frothSetInstance"},
      {frothDestroyInstance(context_, instance_), "frothDestroyInstance"},
      {frothDestroyView(context_, view_), "frothDestroyView"},
      {frothGetViewStatus(context_, view_, &viewStatus), "frothGetViewStatus"},
      {frothRecordRaster(context_, view_, nullptr, &renderInfo), "frothRecordRaster"},
      {frothRecordWalk(context_, view_, nullptr, &renderInfo), "frothRecordWalk"},
      {frothLocate(context_, instance_, point, &location), "frothLocate"},
  };
  ASSERT_EQ(messages_.size(), std::size(results)) << "one message each";
  for (size_t i = 0; i < std::size(results); ++i) {
    EXPECT_EQ(results[i].first, FROTH_ERROR_HANDLE) << results[i].second;
    EXPECT_EQ(messages_[i].object, results[i].second);
    EXPECT_THAT(messages_[i].text, HasSubstr("{0, 1}")) << results[i].second;
  }
}

TEST_F(Misuse, OfANullContextPointerIsAnErrorOfEveryCall) {
  FrothAsset asset{};
  EXPECT_EQ(frothSetBudget(nullptr, 1), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothGetMemoryReport(nullptr, nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothDeviceLost(nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothRestoreDevice(nullptr, nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothOpenAsset(nullptr, nullptr, &asset), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothCloseAsset(nullptr, asset), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothUpdate(nullptr, nullptr, nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothRecordUpload(nullptr, nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothDropFrame(nullptr, 1), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothDestroyContext(nullptr, 0), FROTH_OK);
}

}  // namespace
}  // namespace froth
