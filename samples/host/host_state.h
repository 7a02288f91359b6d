// What the host keeps to itself.
#pragma once

#include "samples/host/host_instance.h"

namespace froth {

struct Host::State {
  ValidationLog log;  // outlives the instance
  HostInstance instance;
  VkPhysicalDeviceMemoryProperties memory{};
  VkPhysicalDeviceVulkan13Features features13{};
  VkPhysicalDeviceVulkan12Features features12{};
  VkPhysicalDeviceFeatures2 features{};  // the chain the device was made with
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  uint64_t serial = 0;

  Status runCommands(VkDevice onDevice, VkQueue onQueue,
                     const std::function<Status(VkCommandBuffer)>& record);
  // The first memory type that is allowed and has the properties; UINT32_MAX: none.
  uint32_t findMemoryType(uint32_t allowedTypes, VkMemoryPropertyFlags properties) const;
};

}  // namespace froth
