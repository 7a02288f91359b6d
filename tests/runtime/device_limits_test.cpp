// Devices that take small buffers only: what does not fit is an error that names the limit, and nothing larger is asked
// of them.
#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

constexpr VkDeviceSize kLimit = 1 << 20;

VkDeviceSize largestAsked = 0;

VKAPI_ATTR void VKAPI_CALL getProperties(VkPhysicalDevice device, VkPhysicalDeviceProperties2* properties) {
  vkGetPhysicalDeviceProperties2(device, properties);
  for (auto* next = static_cast<VkBaseOutStructure*>(properties->pNext); next; next = next->pNext) {
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES) {
      reinterpret_cast<VkPhysicalDeviceMaintenance4Properties*>(next)->maxBufferSize = kLimit;
    }
  }
}

VKAPI_ATTR VkResult VKAPI_CALL createBuffer(VkDevice device, const VkBufferCreateInfo* info,
                                            const VkAllocationCallbacks* callbacks, VkBuffer* buffer) {
  largestAsked = std::max(largestAsked, info->size);
  return vkCreateBuffer(device, info, callbacks, buffer);
}

PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
  if (std::strcmp(name, "vkCreateBuffer") == 0) return reinterpret_cast<PFN_vkVoidFunction>(createBuffer);
  return vkGetDeviceProcAddr(device, name);
}

PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
  if (std::strcmp(name, "vkGetPhysicalDeviceProperties2") == 0) {
    return reinterpret_cast<PFN_vkVoidFunction>(getProperties);
  }
  return vkGetInstanceProcAddr(instance, name);
}

class DeviceLimits : public RuntimeGpuTest {};

// The upload ring is the largest buffer that every context has.
TEST_F(DeviceLimits, ABufferThatIsTooLargeIsRefusedByTheNameOfTheLimitAndNotAskedFor) {
  FrothContextInfo info = host_->contextInfo();
  info.getInstanceProcAddr = getInstanceProcAddr;
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_MEMORY);
  EXPECT_THAT(lastText(), HasSubstr("upload ring"));
  EXPECT_THAT(lastText(), HasSubstr("maxBufferSize 1048576"));
  EXPECT_LE(largestAsked, kLimit);
}

}  // namespace
}  // namespace froth
