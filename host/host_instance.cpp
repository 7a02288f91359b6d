#include "host/host_instance.h"

#include <algorithm>
#include <cstring>

namespace froth {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL logMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  auto* log = static_cast<ValidationLog*>(user);
  std::string text;
  for (uint32_t i = 0; i < data->cmdBufLabelCount; ++i) {
    text += std::string("[") + data->pCmdBufLabels[i].pLabelName + "] ";
  }
  const std::lock_guard<std::mutex> lock(log->mutex);
  log->messages.push_back(text + data->pMessage);
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfoFor(ValidationLog* log) {
  VkDebugUtilsMessengerCreateInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = logMessage;
  info.pUserData = log;
  return info;
}

bool hasValidationLayer() {
  uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
    return std::strcmp(layer.layerName, kValidationLayer) == 0;
  });
}

// Where a device stands when nobody named one: GPUs before CPUs.
int rankOf(const HostDeviceInfo& info) {
  switch (info.type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    default:
      return 3;
  }
}

HostDeviceInfo describeDevice(VkInstance instance, VkPhysicalDevice physicalDevice) {
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &driver;
  vkGetPhysicalDeviceProperties2(physicalDevice, &properties);

  HostDeviceInfo info;
  info.name = properties.properties.deviceName;
  info.driver = std::string(driver.driverName) + " " + driver.driverInfo;
  info.apiVersion = properties.properties.apiVersion;
  info.type = properties.properties.deviceType;
  FrothRequirements requirements{};
  requirements.structSize = sizeof(requirements);
  frothGetRequirements(vkGetInstanceProcAddr, instance, physicalDevice, &requirements);
  info.isSuitable = requirements.isSatisfied != 0;
  for (uint32_t i = 0; i < requirements.itemCount; ++i) {
    const FrothRequirement& item = requirements.items[i];
    if (!item.isPresent && !item.loss) {
      info.missing += (info.missing.empty() ? "" : ", ") + std::string(item.name);
    }
  }
  return info;
}

std::string listNames(const std::vector<HostDeviceChoice>& devices) {
  std::string names;
  for (size_t i = 0; i < devices.size(); ++i) {
    names += (i == 0 ? "" : ", ") + std::to_string(i) + ": " + devices[i].info.name;
  }
  return names.empty() ? "none" : names;
}

}  // namespace

Result<HostInstance> createHostInstance(ValidationLog* log, std::vector<const char*> extensions) {
  if (log && !hasValidationLayer()) {
    return makeError(ErrorKind::kUnsupported,
                     "validation: the layer %s is not installed; install vulkan-validationlayers", kValidationLayer);
  }
  const VkDebugUtilsMessengerCreateInfoEXT messengerInfo = messengerInfoFor(log);
  const VkValidationFeatureEnableEXT enabled[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  VkValidationFeaturesEXT validation{};
  validation.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
  validation.pNext = &messengerInfo;
  validation.enabledValidationFeatureCount = 1;
  validation.pEnabledValidationFeatures = enabled;

  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.pApplicationName = "froth_host";
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  if (log) {
    info.pNext = &validation;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
  }
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  HostInstance result;
  if (const VkResult code = vkCreateInstance(&info, nullptr, &result.instance); code != VK_SUCCESS) {
    return makeError(ErrorKind::kUnsupported,
                     "vkCreateInstance gives VkResult %d; install a Vulkan driver (mesa-vulkan-drivers works "
                     "without a GPU)",
                     code);
  }
  if (log) result.messenger = createMessenger(result.instance, *log);
  return result;
}

void destroyHostInstance(HostInstance& instance) {
  if (instance.messenger) destroyMessenger(instance.instance, instance.messenger);
  vkDestroyInstance(instance.instance, nullptr);
  instance = {};
}

VkDebugUtilsMessengerEXT createMessenger(VkInstance instance, ValidationLog& log) {
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
  const VkDebugUtilsMessengerCreateInfoEXT info = messengerInfoFor(&log);
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  create(instance, &info, nullptr, &messenger);
  return messenger;
}

void destroyMessenger(VkInstance instance, VkDebugUtilsMessengerEXT messenger) {
  const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
  destroy(instance, messenger, nullptr);
}

Result<std::vector<HostDeviceChoice>> enumerateHostDevices(VkInstance instance) {
  uint32_t count = 0;
  if (const VkResult code = vkEnumeratePhysicalDevices(instance, &count, nullptr); code != VK_SUCCESS) {
    return makeError(ErrorKind::kUnsupported, "vkEnumeratePhysicalDevices gives VkResult %d", code);
  }
  std::vector<VkPhysicalDevice> physicalDevices(count);
  vkEnumeratePhysicalDevices(instance, &count, physicalDevices.data());
  std::vector<HostDeviceChoice> devices;
  for (uint32_t i = 0; i < count; ++i) {
    devices.push_back({physicalDevices[i], describeDevice(instance, physicalDevices[i])});
  }
  return devices;
}

Result<HostDeviceChoice> chooseHostDevice(const std::vector<HostDeviceChoice>& devices, const std::string& wanted) {
  const HostDeviceChoice* chosen = nullptr;
  for (size_t i = 0; i < devices.size(); ++i) {
    const HostDeviceInfo& info = devices[i].info;
    if (wanted.empty()) {
      const bool isBetter = !chosen || rankOf(info) < rankOf(chosen->info);
      chosen = info.isSuitable && isBetter ? &devices[i] : chosen;
    } else if (!chosen && (wanted == std::to_string(i) || info.name.find(wanted) != std::string::npos)) {
      chosen = &devices[i];
    }
  }
  if (!chosen) {
    const char* what = wanted.empty() ? "suitable" : wanted.c_str();
    return makeError(wanted.empty() ? ErrorKind::kUnsupported : ErrorKind::kUsage,
                     "no Vulkan device '%s'; the devices are %s", what, listNames(devices).c_str());
  }
  if (!chosen->info.isSuitable) {
    return makeError(ErrorKind::kUnsupported, "device '%s' lacks %s", chosen->info.name.c_str(),
                     chosen->info.missing.c_str());
  }
  return *chosen;
}

}  // namespace froth
