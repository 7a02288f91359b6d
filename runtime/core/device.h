// The caller's VkDevice as the runtime uses it: a function table and buffers reached by address.
#pragma once

#include <cstdint>
#include <string>

#include <vulkan/vulkan_core.h>

#include "format/result.h"

namespace froth {

// Device-level functions the runtime calls, loaded per context: no globals, no loader symbols.
// clang-format off
#define FROTH_DEVICE_FUNCTIONS(X) \
  X(vkAllocateMemory) X(vkFreeMemory) X(vkMapMemory) X(vkCreateBuffer) X(vkDestroyBuffer) \
  X(vkGetBufferMemoryRequirements) X(vkBindBufferMemory) X(vkGetBufferDeviceAddress) \
  X(vkCreateShaderModule) X(vkDestroyShaderModule) X(vkCreateComputePipelines) X(vkDestroyPipeline) \
  X(vkCreatePipelineLayout) X(vkDestroyPipelineLayout) X(vkCreateDescriptorSetLayout) \
  X(vkDestroyDescriptorSetLayout) X(vkCreateDescriptorPool) X(vkDestroyDescriptorPool) \
  X(vkAllocateDescriptorSets) X(vkUpdateDescriptorSets) X(vkCreateQueryPool) X(vkDestroyQueryPool) \
  X(vkGetQueryPoolResults) X(vkCmdBindPipeline) X(vkCmdBindDescriptorSets) X(vkCmdPushConstants) \
  X(vkCmdDispatch) X(vkCmdDispatchIndirect) X(vkCmdPipelineBarrier2) X(vkCmdCopyBuffer) \
  X(vkCmdFillBuffer) X(vkCmdUpdateBuffer) \
  X(vkCmdResetQueryPool) X(vkCmdWriteTimestamp2) X(vkCreateImage) X(vkDestroyImage) \
  X(vkGetImageMemoryRequirements) X(vkBindImageMemory) X(vkCreateImageView) X(vkDestroyImageView)
// clang-format on

struct DeviceTable {
#define FROTH_DECLARE(name) PFN_##name name = nullptr;
  FROTH_DEVICE_FUNCTIONS(FROTH_DECLARE)
#undef FROTH_DECLARE

  // One global memory barrier between two uses of buffers.
  void recordMemoryBarrier(VkCommandBuffer commandBuffer, VkPipelineStageFlags2 fromStage, VkAccessFlags2 fromAccess,
                           VkPipelineStageFlags2 toStage, VkAccessFlags2 toAccess) const;
};

enum class BufferKind {
  kDevice,    // storage, indirect, transfer source and target; reached by address
  kStaging,   // host-visible, mapped, transfer source
  kReadback,  // host-visible, mapped, cached where offered; storage and transfer target
};

struct GpuBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize size = 0;
  VkDeviceAddress address = 0;  // 0 for kStaging
  void* mapped = nullptr;       // null for kDevice
  BufferKind kind = BufferKind::kDevice;
  VkDeviceSize allocatedSize = 0;  // what the budget is charged
};

// Owns nothing of the caller's. One thread at a time.
class Device {
 public:
  static Result<Device> create(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance,
                               VkPhysicalDevice physicalDevice, VkDevice device);

  // Fails with a message that names `purpose`, the size and the budget. size > 0.
  Result<GpuBuffer> createBuffer(BufferKind kind, VkDeviceSize size, const char* purpose);
  void destroyBuffer(GpuBuffer& buffer);  // the GPU must be done with it; resets it to empty

  DeviceTable table;
  VkDevice device = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties{};
  VkPhysicalDeviceMemoryProperties memory{};
  VkDeviceSize maxAllocationSize = 0;  // largest buffer the device promises to accept
  VkDeviceSize budget = 0;             // [bytes] 0: no limit
  VkDeviceSize deviceBytes = 0;        // held now, kDevice
  VkDeviceSize hostBytes = 0;          // held now, kStaging and kReadback

 private:
  Status bindMemory(GpuBuffer& buffer, const char* purpose);
};

}  // namespace froth
