#include "runtime/core/device.h"

#include <algorithm>
#include <optional>

namespace froth {
namespace {

struct KindTraits {
  VkBufferUsageFlags usage;
  VkMemoryPropertyFlags required;
  VkMemoryPropertyFlags preferred;
  bool hasAddress;
};

KindTraits traitsOf(BufferKind kind) {
  constexpr VkMemoryPropertyFlags kVisible =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                          VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  switch (kind) {
    case BufferKind::kStaging:
      return {VK_BUFFER_USAGE_TRANSFER_SRC_BIT, kVisible, 0, false};
    case BufferKind::kReadback:
      return {kStorage, kVisible, VK_MEMORY_PROPERTY_HOST_CACHED_BIT, true};
    case BufferKind::kDevice:
      break;
  }
  return {kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, true};
}

std::optional<uint32_t> findMemoryType(const VkPhysicalDeviceMemoryProperties& memory, uint32_t allowedTypes,
                                       const KindTraits& traits) {
  for (const VkMemoryPropertyFlags wanted : {traits.required | traits.preferred, traits.required}) {
    for (uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
      const bool isAllowed = (allowedTypes >> type & 1) != 0;
      if (isAllowed && (memory.memoryTypes[type].propertyFlags & wanted) == wanted) {
        return type;
      }
    }
  }
  return std::nullopt;
}

unsigned long long asPrinted(VkDeviceSize bytes) {
  return bytes;
}

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
    return makeError(
        ErrorKind::kUnsupported,
        "vkGetInstanceProcAddr: gives no vkGetPhysicalDeviceProperties2 for this instance; create the "
        "instance with VkApplicationInfo::apiVersion of at least 1.3");
  }

  Device result;
  result.device = device;
#define FROTH_LOAD(name)                                                                              \
  result.table.name = reinterpret_cast<PFN_##name>(getDeviceProcAddr(device, #name));                 \
  if (!result.table.name) {                                                                           \
    return makeError(ErrorKind::kUnsupported,                                                         \
                     "vkGetDeviceProcAddr: gives no " #name "; the device must be a Vulkan 1.3 one"); \
  }
  FROTH_DEVICE_FUNCTIONS(FROTH_LOAD)
#undef FROTH_LOAD

  VkPhysicalDeviceMaintenance3Properties limits{};
  limits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &limits;
  getProperties(physicalDevice, &properties);
  result.properties = properties.properties;
  result.maxAllocationSize = limits.maxMemoryAllocationSize;
  getMemoryProperties(physicalDevice, &result.memory);
  return result;
}

Result<GpuBuffer> Device::createBuffer(BufferKind kind, VkDeviceSize size, const char* purpose) {
  if (size > maxAllocationSize) {
    return makeError(
        ErrorKind::kUnsupported,
        "%s: %llu bytes, but this device allocates at most %llu at once; use a smaller asset or view",
        purpose, asPrinted(size), asPrinted(maxAllocationSize));
  }
  VkBufferCreateInfo bufferInfo{};
  bufferInfo.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  bufferInfo.size = size;
  bufferInfo.usage = traitsOf(kind).usage;
  GpuBuffer buffer;
  buffer.kind = kind;
  buffer.size = size;
  if (const VkResult result = table.vkCreateBuffer(device, &bufferInfo, nullptr, &buffer.buffer);
      result != VK_SUCCESS) {
    return makeError(ErrorKind::kUnsupported, "%s: vkCreateBuffer of %llu bytes gives VkResult %d", purpose,
                     asPrinted(size), result);
  }
  if (const Status status = bindMemory(buffer, purpose); !status) {
    destroyBuffer(buffer);
    return status.error();
  }
  return buffer;
}

Status Device::bindMemory(GpuBuffer& buffer, const char* purpose) {
  const KindTraits traits = traitsOf(buffer.kind);
  VkMemoryRequirements requirements{};
  table.vkGetBufferMemoryRequirements(device, buffer.buffer, &requirements);
  const bool isCharged = buffer.kind == BufferKind::kDevice && budget != 0;
  if (isCharged && requirements.size > budget - std::min(budget, deviceBytes)) {
    return makeError(ErrorKind::kUnsupported,
                     "%s: %llu bytes do not fit the device budget: %llu of %llu bytes are in use; raise "
                     "FrothContextInfo::deviceBudget by %llu bytes or close another asset or view",
                     purpose, asPrinted(requirements.size), asPrinted(deviceBytes), asPrinted(budget),
                     asPrinted(requirements.size - (budget - std::min(budget, deviceBytes))));
  }
  const std::optional<uint32_t> type = findMemoryType(memory, requirements.memoryTypeBits, traits);
  if (!type) {
    return makeError(ErrorKind::kUnsupported, "%s: no memory type of this device fits (allowed types 0x%x)",
                     purpose, requirements.memoryTypeBits);
  }

  VkMemoryAllocateFlagsInfo flags{};
  flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
  flags.flags = traits.hasAddress ? VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT : 0;
  VkMemoryAllocateInfo allocation{};
  allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  allocation.pNext = &flags;
  allocation.allocationSize = requirements.size;
  allocation.memoryTypeIndex = *type;
  if (const VkResult result = table.vkAllocateMemory(device, &allocation, nullptr, &buffer.memory);
      result != VK_SUCCESS) {
    return makeError(
        ErrorKind::kUnsupported,
        "%s: vkAllocateMemory of %llu bytes gives VkResult %d with %llu bytes in use; close another asset "
        "or view",
        purpose, asPrinted(requirements.size), result, asPrinted(deviceBytes));
  }
  buffer.allocatedSize = requirements.size;
  (buffer.kind == BufferKind::kDevice ? deviceBytes : hostBytes) += buffer.allocatedSize;

  VkResult result = table.vkBindBufferMemory(device, buffer.buffer, buffer.memory, 0);
  if (result == VK_SUCCESS && buffer.kind != BufferKind::kDevice) {
    result = table.vkMapMemory(device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped);
  }
  if (result != VK_SUCCESS) {
    return makeError(ErrorKind::kUnsupported, "%s: binding %llu bytes of memory gives VkResult %d", purpose,
                     asPrinted(requirements.size), result);
  }
  if (traits.hasAddress) {
    VkBufferDeviceAddressInfo addressInfo{};
    addressInfo.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    addressInfo.buffer = buffer.buffer;
    buffer.address = table.vkGetBufferDeviceAddress(device, &addressInfo);
  }
  return {};
}

void Device::destroyBuffer(GpuBuffer& buffer) {
  (buffer.kind == BufferKind::kDevice ? deviceBytes : hostBytes) -= buffer.allocatedSize;
  table.vkDestroyBuffer(device, buffer.buffer, nullptr);
  table.vkFreeMemory(device, buffer.memory, nullptr);  // unmaps
  buffer = {};
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
