// What the host keeps to itself.
#pragma once

#include "host/host_instance.h"

namespace froth {

// A host-visible buffer that goes with its scope.
struct TransferBuffer {
  VkDevice device = VK_NULL_HANDLE;
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  void* mapped = nullptr;

  ~TransferBuffer() {
    vkDestroyBuffer(device, buffer, nullptr);
    vkFreeMemory(device, memory, nullptr);
  }
};

struct Host::State {
  ValidationLog log;  // outlives the instance
  HostInstance instance;
  VkPhysicalDeviceMemoryProperties memory{};
  bool usesGraphics = false;  // HostOptions
  VkPhysicalDeviceVulkan13Features features13{};
  VkPhysicalDeviceVulkan12Features features12{};
  VkPhysicalDeviceFeatures2 features{};  // the chain the device was made with
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  uint64_t serial = 0;

  Status runCommands(VkDevice onDevice, VkQueue onQueue, const std::function<Status(VkCommandBuffer)>& record);
  // The first memory type that is allowed and has the properties; UINT32_MAX: none.
  uint32_t findMemoryType(uint32_t allowedTypes, VkMemoryPropertyFlags properties) const;
  Status createTransferBuffer(VkDevice onDevice, VkDeviceSize bytes, VkBufferUsageFlags usage,
                              TransferBuffer& transfer) const;
};

}  // namespace froth
