// The instance and the choice of a device, shared by the host's files.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "base/result.h"
#include "host/host.h"

namespace froth {

// What the validation layers said; they may speak on any thread.
struct ValidationLog {
  std::mutex mutex;
  std::vector<std::string> messages;
};

struct HostInstance {
  VkInstance instance = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
};

struct HostDeviceChoice {
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  HostDeviceInfo info;
};

// `log` null: no validation. Else it must outlive the instance.
Result<HostInstance> createHostInstance(ValidationLog* log, std::vector<const char*> extensions);
void destroyHostInstance(HostInstance& instance);

// For an instance that another makes, with VK_EXT_debug_utils; createHostInstance() makes its own.
VkDebugUtilsMessengerEXT createMessenger(VkInstance instance, ValidationLog& log);
void destroyMessenger(VkInstance instance, VkDebugUtilsMessengerEXT messenger);

Result<std::vector<HostDeviceChoice>> enumerateHostDevices(VkInstance instance);
// `wanted` as HostOptions::device.
Result<HostDeviceChoice> chooseHostDevice(const std::vector<HostDeviceChoice>& devices, const std::string& wanted);

}  // namespace froth
