// Passes in timestamps, of queue families that count in fewer bits than 64 or not at all, and in captures.
#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

constexpr uint64_t kTicks = 20;  // of every pass

uint32_t plantedBits = 0;

VKAPI_ATTR void VKAPI_CALL getFamilies(VkPhysicalDevice device, uint32_t* count, VkQueueFamilyProperties* families) {
  vkGetPhysicalDeviceQueueFamilyProperties(device, count, families);
  for (uint32_t i = 0; families && i < *count; ++i) families[i].timestampValidBits = plantedBits;
}

// The counter wraps behind the first stamp.
VKAPI_ATTR VkResult VKAPI_CALL getStamps(VkDevice, VkQueryPool, uint32_t, uint32_t count, size_t, void* data,
                                         VkDeviceSize, VkQueryResultFlags) {
  const uint64_t mask = (uint64_t{1} << plantedBits) - 1;
  for (uint64_t i = 0; i < count; ++i) static_cast<uint64_t*>(data)[i] = (mask - kTicks / 2 + i * kTicks) & mask;
  return VK_SUCCESS;
}

std::vector<std::string> labels;  // begun, each with a space per label that it lies in
size_t openLabels = 0;

VKAPI_ATTR void VKAPI_CALL beginLabel(VkCommandBuffer, const VkDebugUtilsLabelEXT* label) {
  labels.push_back(std::string(openLabels++, ' ') + label->pLabelName);
}

VKAPI_ATTR void VKAPI_CALL endLabel(VkCommandBuffer) { --openLabels; }

PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
  if (std::strcmp(name, "vkCmdBeginDebugUtilsLabelEXT") == 0) return reinterpret_cast<PFN_vkVoidFunction>(beginLabel);
  if (std::strcmp(name, "vkCmdEndDebugUtilsLabelEXT") == 0) return reinterpret_cast<PFN_vkVoidFunction>(endLabel);
  if (std::strcmp(name, "vkGetQueryPoolResults") == 0) return reinterpret_cast<PFN_vkVoidFunction>(getStamps);
  return vkGetDeviceProcAddr(device, name);
}

PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
  if (std::strcmp(name, "vkGetPhysicalDeviceQueueFamilyProperties") == 0) {
    return reinterpret_cast<PFN_vkVoidFunction>(getFamilies);
  }
  return vkGetInstanceProcAddr(instance, name);
}

class Timestamps : public RuntimeGpuTest {
 protected:
  // The status of a view that measures its passes, after a frame.
  FrothViewStatus measure(uint32_t bits) {
    plantedBits = bits;
    labels.clear();
    FrothContextInfo info = host_->contextInfo();
    info.getInstanceProcAddr = getInstanceProcAddr;
    createContext(info);
    auto viewInfo = makeStruct<FrothViewInfo>();
    viewInfo.maxExtent = {16, 16};
    viewInfo.measurePasses = 1;
    FrothView view{};
    EXPECT_EQ(frothCreateView(context_, &viewInfo, &view), FROTH_OK) << lastText();
    Result<HostImage> image = host_->createImage(VK_FORMAT_R16G16B16A16_SFLOAT, {16, 16});
    EXPECT_TRUE(image) << image.error().message;
    createInstance(openBytes(encodeSample()));
    auto draw = makeStruct<FrothRenderInfo>();
    draw.camera = makeCamera(16, 16);
    draw.colour = host_->describe(*image);
    runFrame(
        0, [&](VkCommandBuffer commands) { EXPECT_EQ(frothRecordRaster(context_, view, commands, &draw), FROTH_OK); });
    runFrame();
    auto status = makeStruct<FrothViewStatus>();
    EXPECT_EQ(frothGetViewStatus(context_, view, &status), FROTH_OK);
    host_->destroyImage(*image);
    return status;
  }
};

TEST_F(Timestamps, OfACounterThatWrapsAreItsDifferences) {
  const FrothViewStatus status = measure(36);
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(host_->physicalDevice, &properties);
  ASSERT_GT(status.passCount, 2u);
  for (uint32_t i = 0; i < status.passCount; ++i) {
    EXPECT_DOUBLE_EQ(status.passes[i].milliseconds, kTicks * double{properties.limits.timestampPeriod} * 1e-6)
        << status.passes[i].name;
  }
}

TEST_F(Timestamps, HaveTheNamesThatCapturesShow) {
  const FrothViewStatus status = measure(36);
  std::vector<std::string> expected = {"froth raster"};
  for (uint32_t i = 0; i < status.passCount; ++i) expected.push_back(std::string(" ") + status.passes[i].name);
  EXPECT_EQ(labels, expected);
  EXPECT_EQ(openLabels, 0u);
}

TEST_F(Timestamps, OfAFamilyThatTakesNoneAreLeftOutWithAWarning) {
  EXPECT_EQ(measure(0).passCount, 0u);
  EXPECT_THAT(messages_,
              ::testing::Contains(::testing::Field(&LoggedMessage::text, HasSubstr("0 timestampValidBits"))));
}

}  // namespace
}  // namespace froth
