#include "runtime/device/requirements.h"

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "shaders/gpu/layout.h"

namespace froth {
namespace {

// A feature bit stands in the structure of its core version or in its own; a chain holds one of the two.
struct FeatureHome {
  VkStructureType type;
  const char* name;
  size_t offset;
};

struct RequiredFeature {
  const char* name;
  FeatureHome homes[2];
};

#define FROTH_HOME(type, structure, member) \
  { type, #structure, offsetof(structure, member) }
constexpr RequiredFeature kRequiredFeatures[] = {
    {"bufferDeviceAddress",
     {FROTH_HOME(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, VkPhysicalDeviceVulkan12Features,
                 bufferDeviceAddress),
      FROTH_HOME(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES,
                 VkPhysicalDeviceBufferDeviceAddressFeatures, bufferDeviceAddress)}},
    {"synchronization2",
     {FROTH_HOME(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, VkPhysicalDeviceVulkan13Features,
                 synchronization2),
      FROTH_HOME(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES, VkPhysicalDeviceSynchronization2Features,
                 synchronization2)}},
};
constexpr RequiredFeature kDynamicRendering = {
    "dynamicRendering",
    {FROTH_HOME(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, VkPhysicalDeviceVulkan13Features,
                dynamicRendering),
     FROTH_HOME(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES, VkPhysicalDeviceDynamicRenderingFeatures,
                dynamicRendering)}};
#undef FROTH_HOME

constexpr uint32_t kApiVersion = VK_API_VERSION_1_3;
static_assert(gpu::kGroupSize == 256, "as the items say");

// The feature's bit in a chain; null if neither of its homes is there.
VkBool32* findFeature(void* chain, const RequiredFeature& feature) {
  for (auto* link = static_cast<VkBaseOutStructure*>(chain); link; link = link->pNext) {
    for (const FeatureHome& home : feature.homes) {
      if (link->sType == home.type) {
        return reinterpret_cast<VkBool32*>(reinterpret_cast<char*>(link) + home.offset);
      }
    }
  }
  return nullptr;
}

bool isEnabled(const VkPhysicalDeviceFeatures2& chain, const RequiredFeature& feature) {
  const VkBool32* bit = findFeature(const_cast<VkPhysicalDeviceFeatures2*>(&chain), feature);
  return bit && *bit;
}

// What a physical device offers; all zero without one.
struct Offer {
  VkPhysicalDeviceProperties properties{};
  std::vector<VkQueueFamilyProperties> queueFamilies;
  VkPhysicalDeviceVulkan13Features features13{};
  VkPhysicalDeviceVulkan12Features features12{};
  VkPhysicalDeviceFeatures2 features{};
};

void linkFeatures(Offer& offer) {
  offer.features13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  offer.features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  offer.features12.pNext = &offer.features13;
  offer.features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  offer.features.pNext = &offer.features12;
}

void queryOffer(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance, VkPhysicalDevice physicalDevice,
                Offer& offer) {
  const auto getProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties>(
      getInstanceProcAddr(instance, "vkGetPhysicalDeviceProperties"));
  const auto getFamilies = reinterpret_cast<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(
      getInstanceProcAddr(instance, "vkGetPhysicalDeviceQueueFamilyProperties"));
  const auto getFeatures =
      reinterpret_cast<PFN_vkGetPhysicalDeviceFeatures2>(getInstanceProcAddr(instance, "vkGetPhysicalDeviceFeatures2"));
  if (!getProperties || !getFamilies || !getFeatures) {
    return;  // an instance older than Vulkan 1.1: nothing is offered
  }
  getProperties(physicalDevice, &offer.properties);
  uint32_t count = 0;
  getFamilies(physicalDevice, &count, nullptr);
  offer.queueFamilies.resize(count);
  getFamilies(physicalDevice, &count, offer.queueFamilies.data());
  getFeatures(physicalDevice, &offer.features);
}

bool hasCompute(const Offer& offer) {
  for (const VkQueueFamilyProperties& family : offer.queueFamilies) {
    if (family.queueFlags & VK_QUEUE_COMPUTE_BIT) {
      return true;
    }
  }
  return false;
}

void addItem(FrothRequirements& requirements, const char* name, const char* loss, bool isPresent, bool isFeature) {
  requirements.items[requirements.itemCount++] = {name, loss, isPresent, isFeature};
}

}  // namespace

FrothRequirements queryRequirements(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance,
                                    VkPhysicalDevice physicalDevice) {
  Offer offer;
  linkFeatures(offer);
  if (physicalDevice) {
    queryOffer(getInstanceProcAddr, instance, physicalDevice, offer);
  }
  FrothRequirements requirements{};
  requirements.structSize = sizeof(requirements);
  requirements.apiVersion = kApiVersion;
  addItem(requirements, "Vulkan 1.3", nullptr, offer.properties.apiVersion >= kApiVersion, false);
  addItem(requirements, "a queue family with VK_QUEUE_COMPUTE_BIT", nullptr, hasCompute(offer), false);
  for (const RequiredFeature& feature : kRequiredFeatures) {
    addItem(requirements, feature.name, nullptr, isEnabled(offer.features, feature), true);
  }
  const VkPhysicalDeviceLimits& limits = offer.properties.limits;
  addItem(requirements, "maxComputeWorkGroupSize[0] >= 256", nullptr,
          limits.maxComputeWorkGroupSize[0] >= gpu::kGroupSize, false);
  addItem(requirements, "maxComputeWorkGroupInvocations >= 256", nullptr,
          limits.maxComputeWorkGroupInvocations >= gpu::kGroupSize, false);
  addItem(requirements, "timestampComputeAndGraphics", "the times of passes (FrothViewStatus::passes)",
          limits.timestampComputeAndGraphics, false);
  addItem(requirements, "shaderStorageImageExtendedFormats", "the images id, motion and reactive (FrothRenderInfo)",
          offer.features.features.shaderStorageImageExtendedFormats, true);
  addItem(requirements, kDynamicRendering.name, "frothRecordDepthExport", isEnabled(offer.features, kDynamicRendering),
          true);

  requirements.isSatisfied = 1;
  for (uint32_t i = 0; i < requirements.itemCount; ++i) {
    const FrothRequirement& item = requirements.items[i];
    requirements.isSatisfied &= item.isPresent | (item.loss != nullptr);
  }
  return requirements;
}

const char* requireFeatures(VkPhysicalDeviceFeatures2& features) {
  const char* missing = nullptr;
  for (const RequiredFeature& feature : kRequiredFeatures) {
    if (VkBool32* bit = findFeature(&features, feature)) {
      *bit = VK_TRUE;
    } else if (!missing) {
      missing = feature.homes[0].name;
    }
  }
  return missing;
}

FrothResult checkContextDevice(const FrothContextInfo& info, const Messages& messages, const char* call) {
  const FrothRequirements requirements =
      queryRequirements(info.getInstanceProcAddr, info.instance, info.physicalDevice);
  std::string missing;
  for (uint32_t i = 0; i < requirements.itemCount; ++i) {
    const FrothRequirement& item = requirements.items[i];
    if (!item.loss && !item.isPresent) {
      missing += missing.empty() ? item.name : std::string(", ") + item.name;
    }
  }
  if (!missing.empty()) {
    return messages.fail(FROTH_ERROR_FEATURE, call,
                         "the physical device lacks %s; frothGetRequirements tells beforehand", missing.c_str());
  }
  for (const RequiredFeature& feature : kRequiredFeatures) {
    if (!isEnabled(*info.enabledFeatures, feature)) {
      missing += missing.empty() ? feature.name : std::string(", ") + feature.name;
    }
  }
  if (!missing.empty()) {
    return messages.fail(FROTH_ERROR_FEATURE, call,
                         "enabledFeatures: the device was made without %s; call frothRequireFeatures on the chain "
                         "before vkCreateDevice",
                         missing.c_str());
  }

  Offer offer;
  linkFeatures(offer);
  queryOffer(info.getInstanceProcAddr, info.instance, info.physicalDevice, offer);
  std::string valid;
  for (size_t family = 0; family < offer.queueFamilies.size(); ++family) {
    if (offer.queueFamilies[family].queueFlags & VK_QUEUE_COMPUTE_BIT) {
      if (family == info.queueFamily) {
        return FROTH_OK;
      }
      valid += (valid.empty() ? "" : ", ") + std::to_string(family);
    }
  }
  return messages.fail(FROTH_ERROR_ARGUMENT, call,
                       "queueFamily: %u; those with VK_QUEUE_COMPUTE_BIT are %s; name the one that frames are "
                       "submitted to",
                       info.queueFamily, valid.c_str());
}

uint32_t timestampBitsOf(const FrothContextInfo& info) {
  Offer offer;
  linkFeatures(offer);
  queryOffer(info.getInstanceProcAddr, info.instance, info.physicalDevice, offer);
  return offer.queueFamilies[info.queueFamily].timestampValidBits;
}

FrothResult checkDepthExportDevice(const FrothContextInfo& info, const Messages& messages, const char* call) {
  if (!isEnabled(*info.enabledFeatures, kDynamicRendering)) {
    return messages.fail(
        FROTH_ERROR_FEATURE, call,
        "depthExportFormat: the device was made without dynamicRendering; enable it where frothGetRequirements "
        "says that it is present");
  }
  Offer offer;
  linkFeatures(offer);
  queryOffer(info.getInstanceProcAddr, info.instance, info.physicalDevice, offer);
  if (!(offer.queueFamilies[info.queueFamily].queueFlags & VK_QUEUE_GRAPHICS_BIT)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "depthExportFormat: queue family %u cannot draw; name one with VK_QUEUE_GRAPHICS_BIT",
                         info.queueFamily);
  }
  const auto getFormat = reinterpret_cast<PFN_vkGetPhysicalDeviceFormatProperties>(
      info.getInstanceProcAddr(info.instance, "vkGetPhysicalDeviceFormatProperties"));
  VkFormatProperties properties{};
  getFormat(info.physicalDevice, info.depthExportFormat, &properties);
  return properties.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT
             ? FROTH_OK
             : messages.fail(
                   FROTH_ERROR_UNSUPPORTED, call,
                   "depthExportFormat: VkFormat %d cannot be a depth attachment on this device; D16_UNORM always can",
                   info.depthExportFormat);
}

}  // namespace froth
