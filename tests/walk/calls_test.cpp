// The calls of froth_walk.h: order, refusals, memory, the loss of the device.
#include <cstring>
#include <limits>

#include "froth/froth_walk.h"
#include "tests/runtime/runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

// Without a device: what is checked before it is asked.
class WalkCalls : public RuntimeTest {
 protected:
  void createWalking(FrothContextInfo info = nullContextInfo()) {
    info.walkShaders = 1;
    createContext(info);
  }

  FrothResult recordSet(FrothWalkInfo info = makeStruct<FrothWalkInfo>()) {
    set_ = reinterpret_cast<VkDescriptorSet>(1);
    return frothRecordWalkSet(context_, nullptr, &info, &set_);
  }

  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

TEST_F(WalkCalls, NeedAContextThatWasMadeForThem) {
  createContext();
  ASSERT_EQ(update(1), FROTH_OK);
  VkDescriptorSetLayout layout;
  auto status = makeStruct<FrothWalkStatus>();
  EXPECT_EQ(frothGetWalkSetLayout(context_, &layout), FROTH_ERROR_STATE);
  EXPECT_EQ(recordSet(), FROTH_ERROR_STATE);
  EXPECT_EQ(frothRecordRays(context_, nullptr, 16, 16, 1, FROTH_RAY_CLOSEST), FROTH_ERROR_STATE);
  EXPECT_EQ(frothGetWalkStatus(context_, &status), FROTH_ERROR_STATE);
  EXPECT_THAT(lastText(), HasSubstr("walkShaders"));
}

TEST_F(WalkCalls, OnANullContextDoNothing) {
  createWalking();
  EXPECT_EQ(recordSet(), FROTH_ERROR_STATE) << "before the first frame";
  ASSERT_EQ(update(1), FROTH_OK);
  VkDescriptorSetLayout layout = reinterpret_cast<VkDescriptorSetLayout>(1);
  EXPECT_EQ(frothGetWalkSetLayout(context_, &layout), FROTH_OK);
  EXPECT_EQ(layout, VkDescriptorSetLayout(VK_NULL_HANDLE));
  EXPECT_EQ(recordSet(), FROTH_OK);
  EXPECT_EQ(set_, VkDescriptorSet(VK_NULL_HANDLE));
  EXPECT_EQ(frothRecordRays(context_, nullptr, 16, 16, 1, FROTH_RAY_CLOSEST), FROTH_OK);
}

TEST_F(WalkCalls, RefuseNumbersOutOfTheirRange) {
  createWalking();
  ASSERT_EQ(update(1), FROTH_OK);
  auto info = makeStruct<FrothWalkInfo>();
  info.quantile = 1;
  EXPECT_EQ(recordSet(info), FROTH_ERROR_ARGUMENT);
  info.quantile = 0;
  info.cutoff = 1;
  EXPECT_EQ(recordSet(info), FROTH_ERROR_ARGUMENT);
  info.cutoff = 0;
  info.eye[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(recordSet(info), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("eye"));
  EXPECT_EQ(set_, VkDescriptorSet(VK_NULL_HANDLE));
  EXPECT_EQ(frothRecordWalkSet(context_, nullptr, nullptr, &set_), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothRecordWalkSet(context_, nullptr, &info, nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothGetWalkSetLayout(context_, nullptr), FROTH_ERROR_ARGUMENT);
}

class WalkCallsOnADevice : public RuntimeGpuTest {
 protected:
  void createWalking() {
    FrothContextInfo info = host_->contextInfo();
    info.walkShaders = 1;
    createContext(info);
  }

  FrothResult recordSet(VkCommandBuffer commands, FrothWalkInfo info = makeStruct<FrothWalkInfo>()) {
    return frothRecordWalkSet(context_, commands, &info, &set_);
  }

  uint64_t bytesOf(const char* category) {
    auto report = makeStruct<FrothMemoryReport>();
    EXPECT_EQ(frothGetMemoryReport(context_, &report), FROTH_OK);
    for (uint32_t i = 0; i < report.categoryCount; ++i) {
      if (std::strcmp(report.categories[i].name, category) == 0) return report.categories[i].granted;
    }
    ADD_FAILURE() << category;
    return 0;
  }

  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

TEST_F(WalkCallsOnADevice, GiveASetOncePerFrameAndRaysOnlyAfterIt) {
  createWalking();
  createInstance(openBytes(encodeSample()));
  runFrame();
  runFrame(0, [&](VkCommandBuffer commands) {
    EXPECT_EQ(frothRecordRays(context_, commands, 16, 16, 1, FROTH_RAY_CLOSEST), FROTH_ERROR_STATE);
    EXPECT_EQ(recordSet(commands), FROTH_OK) << lastText();
    EXPECT_NE(set_, VkDescriptorSet(VK_NULL_HANDLE));
    EXPECT_EQ(recordSet(commands), FROTH_ERROR_STATE);
    EXPECT_EQ(frothRecordRays(context_, commands, 8, 16, 1, FROTH_RAY_CLOSEST), FROTH_ERROR_ARGUMENT);
    EXPECT_EQ(frothRecordRays(context_, commands, 16, 0, 1, FROTH_RAY_CLOSEST), FROTH_ERROR_ARGUMENT);
    EXPECT_EQ(frothRecordRays(context_, commands, 16, 16, 1, static_cast<FrothRayKind>(3)), FROTH_ERROR_ARGUMENT);
    EXPECT_EQ(frothRecordRays(context_, commands, 16, 16, 0, FROTH_RAY_CLOSEST), FROTH_OK);
  });
}

TEST_F(WalkCallsOnADevice, TellOfInstancesThatAreLeftOut) {
  createWalking();
  const FrothAsset asset = openBytes(encodeSample());
  createInstance(asset);
  runFrame(0, [&](VkCommandBuffer commands) {
    EXPECT_EQ(recordSet(commands), FROTH_OK) << "READY, as its uploads are recorded";
    createInstance(openBytes(encodeSample()));
  });
  runFrame(16, [&](VkCommandBuffer commands) { EXPECT_EQ(recordSet(commands), FROTH_INCOMPLETE) << "OPENING"; });
  runFrame();
  runFrame(0, [&](VkCommandBuffer commands) { EXPECT_EQ(recordSet(commands), FROTH_OK); });
  for (uint32_t i = 2; i <= FROTH_WALK_MOST_INSTANCES; ++i) createInstance(asset);
  runFrame(0, [&](VkCommandBuffer commands) { EXPECT_EQ(recordSet(commands), FROTH_INCOMPLETE) << "too many"; });
}

TEST_F(WalkCallsOnADevice, CountTheirMemoryAndGiveItBackWithTheDevice) {
  createContext(host_->contextInfo());
  EXPECT_EQ(bytesOf("walks"), 0u);
  frothDestroyContext(context_, UINT64_MAX);
  createWalking();
  const uint64_t empty = bytesOf("walks");
  EXPECT_GT(empty, 0u);
  createInstance(openBytes(encodeSample({.chunkCount = 40, .localBits = 16})));
  for (int frame = 0; frame < 50; ++frame) runFrame();
  const uint64_t grown = bytesOf("walks");
  EXPECT_GT(grown, empty);
  EXPECT_EQ(frothDeviceLost(context_), FROTH_OK);
  EXPECT_EQ(bytesOf("walks") + bytesOf("walks, host"), 0u);
  VkDescriptorSetLayout layout;
  EXPECT_EQ(frothGetWalkSetLayout(context_, &layout), FROTH_ERROR_DEVICE);
  FrothContextInfo info = host_->contextInfo();
  info.walkShaders = 1;
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  EXPECT_EQ(frothRestoreDevice(context_, &info), FROTH_OK) << lastText();
  EXPECT_EQ(frothGetWalkSetLayout(context_, &layout), FROTH_OK);
  runFrame(0, [&](VkCommandBuffer commands) { EXPECT_GE(recordSet(commands), FROTH_OK) << lastText(); });
}

}  // namespace
}  // namespace froth
