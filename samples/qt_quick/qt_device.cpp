#include "samples/qt_quick/qt_device.h"

#include <optional>
#include <vector>

#include "host/host_instance.h"
#include "host/vulkan_check.h"

namespace froth {
namespace {

// Qt submits its frames, and so what Froth records, to one queue, and presents from it.
std::optional<uint32_t> findQueueFamily(QVulkanInstance& instance, QWindow& window, VkPhysicalDevice physicalDevice) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice, &count, families.data());
  constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (uint32_t family = 0; family < count; ++family) {
    const bool canDraw = (families[family].queueFlags & kNeeded) == kNeeded;
    if (canDraw && instance.supportsPresent(physicalDevice, family, &window)) return family;
  }
  return std::nullopt;
}

}  // namespace

Result<std::unique_ptr<QtDevice>> QtDevice::create(QVulkanInstance& instance, QWindow& window,
                                                   const std::string& wanted) {
  const Result<std::vector<HostDeviceChoice>> devices = enumerateHostDevices(instance.vkInstance());
  if (!devices) return devices.error();
  const Result<HostDeviceChoice> chosen = chooseHostDevice(*devices, wanted);
  if (!chosen) return chosen.error();
  const std::optional<uint32_t> family = findQueueFamily(instance, window, chosen->physicalDevice);
  if (!family) {
    return makeError(ErrorKind::kUnsupported,
                     "device '%s' has no queue family with graphics and compute that presents to this window",
                     chosen->info.name.c_str());
  }
  std::unique_ptr<QtDevice> device(new QtDevice());
  device->instance_ = instance.vkInstance();
  device->physicalDevice_ = chosen->physicalDevice;
  device->queueFamily_ = *family;
  if (Status set = device->chooseFeatures(); !set) return set.error();
  if (Status made = device->createDevice(); !made) return made.error();
  return device;
}

QtDevice::~QtDevice() {
  if (device_) vkDestroyDevice(device_, nullptr);
}

Status QtDevice::chooseFeatures() {
  features13_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  features12_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  features12_.pNext = &features13_;
  features_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  features_.pNext = &features12_;
  // Qt takes for granted that a device has each Vulkan 1.0 feature that its GPU offers, since a device of its own has
  // them all, except this one.
  vkGetPhysicalDeviceFeatures(physicalDevice_, &features_.features);
  features_.features.robustBufferAccess = VK_FALSE;
  const char* missing = nullptr;
  if (frothRequireFeatures(&features_, &missing) == FROTH_OK) return {};
  return makeError(ErrorKind::kUnsupported, "froth needs features of %s, which this sample does not know", missing);
}

Status QtDevice::createDevice() {
  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = queueFamily_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  const char* const extensions[] = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = &features_;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = 1;
  info.ppEnabledExtensionNames = extensions;
  return checkVulkan(vkCreateDevice(physicalDevice_, &info, nullptr, &device_), "vkCreateDevice");
}

QQuickGraphicsDevice QtDevice::forQt() const {
  return QQuickGraphicsDevice::fromDeviceObjects(physicalDevice_, device_, static_cast<int>(queueFamily_));
}

FrothContextInfo QtDevice::contextInfo() const {
  FrothContextInfo info{};
  info.structSize = sizeof(info);
  info.abiVersion = FROTH_ABI_VERSION;
  info.getInstanceProcAddr = vkGetInstanceProcAddr;
  info.instance = instance_;
  info.physicalDevice = physicalDevice_;
  info.device = device_;
  info.enabledFeatures = &features_;
  info.queueFamily = queueFamily_;
  return info;
}

}  // namespace froth
