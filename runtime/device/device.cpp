#include "runtime/device/device.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <iterator>

namespace froth {
namespace {

// Of all objects that Device::create makes.
struct ObjectTypeName {
  VkObjectType type;
  const char* name;
};
constexpr ObjectTypeName kObjectTypeNames[] = {{VK_OBJECT_TYPE_DESCRIPTOR_POOL, "DescriptorPool"},
                                               {VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, "DescriptorSetLayout"},
                                               {VK_OBJECT_TYPE_IMAGE, "Image"},
                                               {VK_OBJECT_TYPE_IMAGE_VIEW, "ImageView"},
                                               {VK_OBJECT_TYPE_PIPELINE_LAYOUT, "PipelineLayout"},
                                               {VK_OBJECT_TYPE_QUERY_POOL, "QueryPool"},
                                               {VK_OBJECT_TYPE_SHADER_MODULE, "ShaderModule"}};

}  // namespace

Result<Device> Device::create(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance,
                              VkPhysicalDevice physicalDevice, VkDevice device) {
  const auto getDeviceProcAddr =
      reinterpret_cast<PFN_vkGetDeviceProcAddr>(getInstanceProcAddr(instance, "vkGetDeviceProcAddr"));
  const auto getProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(
      getInstanceProcAddr(instance, "vkGetPhysicalDeviceProperties2"));
  const auto getMemoryProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties>(
      getInstanceProcAddr(instance, "vkGetPhysicalDeviceMemoryProperties"));
  if (!getDeviceProcAddr || !getProperties || !getMemoryProperties) {
    return makeError(ErrorKind::kDevice,
                     "vkGetInstanceProcAddr: gives no vkGetPhysicalDeviceProperties2 for this instance; create the "
                     "instance with VkApplicationInfo::apiVersion of at least 1.3");
  }

  Device result;
  result.device = device;
#define FROTH_LOAD(name)                                                                              \
  result.table.name = reinterpret_cast<PFN_##name>(getDeviceProcAddr(device, #name));                 \
  if (!result.table.name) {                                                                           \
    return makeError(ErrorKind::kDevice,                                                              \
                     "vkGetDeviceProcAddr: gives no " #name "; the device must be a Vulkan 1.3 one"); \
  }
  FROTH_DEVICE_FUNCTIONS(FROTH_LOAD)
#undef FROTH_LOAD
  result.table.vkCmdBeginDebugUtilsLabelEXT =
      reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(getDeviceProcAddr(device, "vkCmdBeginDebugUtilsLabelEXT"));
  result.table.vkCmdEndDebugUtilsLabelEXT =
      reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(getDeviceProcAddr(device, "vkCmdEndDebugUtilsLabelEXT"));

  result.table.vkSetDebugUtilsObjectNameEXT =
      reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(getDeviceProcAddr(device, "vkSetDebugUtilsObjectNameEXT"));

  VkPhysicalDeviceMaintenance4Properties bufferLimits{};
  bufferLimits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES;
  VkPhysicalDeviceMaintenance3Properties limits{};
  limits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
  limits.pNext = &bufferLimits;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &limits;
  getProperties(physicalDevice, &properties);
  result.properties = properties.properties;
  result.maxAllocationSize = limits.maxMemoryAllocationSize;
  result.maxBufferSize = bufferLimits.maxBufferSize;
  getMemoryProperties(physicalDevice, &result.memory);
  return result;
}

Result<VkShaderModule> Device::createShaderModule(const char* name, std::span<const uint32_t> spirv) {
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = spirv.size_bytes();
  info.pCode = spirv.data();
  return create(VK_OBJECT_TYPE_SHADER_MODULE, name, table.vkCreateShaderModule, info);
}

Error Device::explainCreation(VkResult result, VkObjectType type, const char* name) {
  const auto entry = std::find_if(std::begin(kObjectTypeNames), std::end(kObjectTypeNames),
                                  [&](const ObjectTypeName& known) { return known.type == type; });
  return explain(result, "%s: vkCreate%s", name, entry->name);
}

void Device::nameHandle(VkObjectType type, uint64_t handle, const char* name) const {
  if (!table.vkSetDebugUtilsObjectNameEXT) {
    return;
  }
  char text[128];
  std::snprintf(text, sizeof(text), "froth: %s", name);
  VkDebugUtilsObjectNameInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
  info.objectType = type;
  info.objectHandle = handle;
  info.pObjectName = text;
  table.vkSetDebugUtilsObjectNameEXT(device, &info);  // without a name an object is as good
}

Error Device::explain(VkResult result, const char* format, ...) {
  char text[512];
  va_list args;
  va_start(args, format);
  std::vsnprintf(text, sizeof(text), format, args);
  va_end(args);
  switch (result) {
    case VK_ERROR_DEVICE_LOST:
      loss->tell(makeError(ErrorKind::kDevice,
                           "%s gives VK_ERROR_DEVICE_LOST; call frothDeviceLost, then frothRestoreDevice", text));
      return *loss->error();
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_TOO_MANY_OBJECTS:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
    case VK_ERROR_FRAGMENTED_POOL:
    case VK_ERROR_MEMORY_MAP_FAILED:
      return makeError(ErrorKind::kMemory, "%s gives VkResult %d: memory is exhausted; close another asset or view",
                       text, result);
    default:
      return makeError(ErrorKind::kDevice, "%s gives VkResult %d; update the device's driver", text, result);
  }
}

void DeviceTable::beginLabel(VkCommandBuffer commandBuffer, const char* name) const {
  if (!vkCmdBeginDebugUtilsLabelEXT) {
    return;
  }
  VkDebugUtilsLabelEXT label{};
  label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
  label.pLabelName = name;
  vkCmdBeginDebugUtilsLabelEXT(commandBuffer, &label);
}

void DeviceTable::endLabel(VkCommandBuffer commandBuffer) const {
  if (vkCmdEndDebugUtilsLabelEXT) {
    vkCmdEndDebugUtilsLabelEXT(commandBuffer);
  }
}

void DeviceTable::recordMemoryBarrier(VkCommandBuffer commandBuffer, VkPipelineStageFlags2 fromStage,
                                      VkAccessFlags2 fromAccess, VkPipelineStageFlags2 toStage,
                                      VkAccessFlags2 toAccess) const {
  VkMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
  barrier.srcStageMask = fromStage;
  barrier.srcAccessMask = fromAccess;
  barrier.dstStageMask = toStage;
  barrier.dstAccessMask = toAccess;
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commandBuffer, &dependency);
}

}  // namespace froth
