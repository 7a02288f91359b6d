// Buffers and the memory that they share.
#include "runtime/device/device.h"

namespace froth {
namespace {

struct KindTraits {
  VkBufferUsageFlags usage;
  VkMemoryPropertyFlags required;
  VkMemoryPropertyFlags preferred;
  bool hasAddress;
};

KindTraits traitsOf(BufferKind kind) {
  constexpr VkMemoryPropertyFlags kVisible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                          VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                          VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  switch (kind) {
    case BufferKind::kStaging:
      return {VK_BUFFER_USAGE_TRANSFER_SRC_BIT, kVisible, 0, false};
    case BufferKind::kReadback:
      return {kStorage, kVisible, VK_MEMORY_PROPERTY_HOST_CACHED_BIT, true};
    case BufferKind::kDevice:
    case BufferKind::kUploaded:
      break;
  }
  return {kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, 0,
          VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, true};
}

// Destroyed unless they are taken.
struct NewBuffers {
  ~NewBuffers() {
    for (GpuBuffer& buffer : buffers) device.destroyBuffer(buffer);
  }
  void take() { buffers = {}; }

  Device& device;
  std::span<GpuBuffer> buffers;
};

}  // namespace

Result<GpuBuffer> Device::createBuffer(MemoryUse use, BufferKind kind, VkDeviceSize size, const char* purpose) {
  const BufferWish wish{size, purpose};
  GpuBuffer buffer;
  const Status status = createBuffers(use, kind, purpose, {&wish, 1}, {&buffer, 1});
  if (!status) return status.error();
  return buffer;
}

Status Device::createBuffers(MemoryUse use, BufferKind kind, const char* purpose, std::span<const BufferWish> wishes,
                             std::span<GpuBuffer> made, bool mayExceedBudget) {
  NewBuffers buffers{*this, made};
  for (size_t i = 0; i < wishes.size(); ++i) {
    made[i].kind = kind;
    if (wishes[i].size == 0) continue;
    if (const Status status = createHandle(wishes[i], made[i]); !status) return status;
  }
  const KindTraits traits = traitsOf(kind);
  const VkMemoryAllocateFlags flags = traits.hasAddress ? VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT : 0;
  const MemoryWish wish{use, traits.required, traits.preferred, flags, purpose, mayExceedBudget};
  for (size_t first = 0; first < made.size();) {
    const Result<size_t> count = shareMemory(made.subspan(first), wish);
    if (!count) return count.error();
    first += *count;
  }
  buffers.take();
  return {};
}

Status Device::createHandle(const BufferWish& wish, GpuBuffer& buffer) {
  if (wish.size > largestBuffer()) {
    return makeError(ErrorKind::kMemory,
                     "%s: %llu bytes, but a buffer of this device has at most %llu (maxMemoryAllocationSize %llu, "
                     "maxBufferSize %llu); "
                     "use a smaller view, or an asset of smaller chunks",
                     wish.name, asPrinted(wish.size), asPrinted(largestBuffer()), asPrinted(maxAllocationSize),
                     asPrinted(maxBufferSize));
  }
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = wish.size;
  info.usage = traitsOf(buffer.kind).usage;
  const uint32_t families[] = {queueFamily, uploadFamily};
  if (buffer.kind == BufferKind::kUploaded && queueFamily != uploadFamily) {
    info.sharingMode = VK_SHARING_MODE_CONCURRENT;
    info.queueFamilyIndexCount = 2;
    info.pQueueFamilyIndices = families;
  }
  if (const VkResult result = table.vkCreateBuffer(device, &info, nullptr, &buffer.buffer); result != VK_SUCCESS) {
    return explain(result, "%s: vkCreateBuffer of %llu bytes", wish.name, asPrinted(wish.size));
  }
  buffer.size = wish.size;
  nameObject(VK_OBJECT_TYPE_BUFFER, buffer.buffer, wish.name);
  return {};
}

// Gives memory to as many of the first buffers as one allocation can hold, and tells how many that are.
Result<size_t> Device::shareMemory(std::span<GpuBuffer> buffers, const MemoryWish& wish) {
  VkMemoryRequirements all = kNoRequirements;
  VkDeviceSize used = 0;
  GpuBuffer* last = nullptr;
  size_t count = 0;
  for (; count < buffers.size(); ++count) {
    GpuBuffer& buffer = buffers[count];
    if (buffer.size == 0) continue;
    VkMemoryRequirements own{}, with = all;
    table.vkGetBufferMemoryRequirements(device, buffer.buffer, &own);
    buffer.offset = append(own, with);
    if (last && with.size > maxAllocationSize) break;
    all = with;
    used += buffer.size;
    last = &buffer;
  }
  if (!last) return count;
  const Result<MemoryBlock> block = allocate(all, used, wish);
  if (!block) return block.error();
  last->memory = *block;
  for (GpuBuffer& buffer : buffers.first(count)) {
    if (buffer.size == 0) continue;
    if (const Status status = bindMemory(*block, buffer, wish); !status) return status.error();
  }
  return count;
}

Status Device::bindMemory(const MemoryBlock& block, GpuBuffer& buffer, const MemoryWish& wish) {
  const VkResult result =
      table.vkBindBufferMemory(device, buffer.buffer, block.place.memory, block.place.offset + buffer.offset);
  if (result != VK_SUCCESS) {
    return explain(result, "%s: vkBindBufferMemory of %llu bytes", wish.purpose, asPrinted(buffer.size));
  }
  if (block.place.mapped) buffer.mapped = static_cast<char*>(block.place.mapped) + buffer.offset;
  if (wish.flags & VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT) {
    VkBufferDeviceAddressInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    info.buffer = buffer.buffer;
    buffer.address = table.vkGetBufferDeviceAddress(device, &info);
  }
  return {};
}

void Device::destroyBuffer(GpuBuffer& buffer) {
  table.vkDestroyBuffer(device, buffer.buffer, nullptr);
  release(buffer.memory);
  buffer = {};
}

}  // namespace froth
