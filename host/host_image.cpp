#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "host/host.h"
#include "host/host_state.h"

namespace froth {
namespace {

struct FormatTraits {
  uint32_t channels;
  uint32_t bytesPerTexel;  // in buffers; of depth and stencil the depth
  VkImageAspectFlags aspects = VK_IMAGE_ASPECT_COLOR_BIT;

  // What is copied and seen.
  VkImageAspectFlags aspect() const { return aspects & ~VkImageAspectFlags{VK_IMAGE_ASPECT_STENCIL_BIT}; }
  bool isDepth() const { return aspect() == VK_IMAGE_ASPECT_DEPTH_BIT; }
};

Result<FormatTraits> traitsOf(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return FormatTraits{4, 8};
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return FormatTraits{4, 16};
    case VK_FORMAT_R32_SFLOAT:
      return FormatTraits{1, 4};
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:  // as one channel
      return FormatTraits{1, 4};
    case VK_FORMAT_R16G16_SFLOAT:
      return FormatTraits{2, 4};
    case VK_FORMAT_R8_UNORM:
      return FormatTraits{1, 1};
    case VK_FORMAT_R32G32_UINT:
      return FormatTraits{2, 8};
    case VK_FORMAT_D32_SFLOAT:
      return FormatTraits{1, 4, VK_IMAGE_ASPECT_DEPTH_BIT};
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return FormatTraits{1, 4, VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT};
    case VK_FORMAT_D16_UNORM:
      return FormatTraits{1, 2, VK_IMAGE_ASPECT_DEPTH_BIT};
    default:
      return makeError(
          ErrorKind::kUnsupported,
          "image: VkFormat %d; the host knows R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT, R32_SFLOAT, "
          "R16G16_SFLOAT, R8_UNORM, R32G32_UINT, B10G11R11_UFLOAT_PACK32, D32_SFLOAT, D32_SFLOAT_S8_UINT and D16_UNORM",
          format);
  }
}

// As the image holds them: bytes, halves, and depths of 16 bits, rounded to the nearest; all else as it is.
std::vector<uint8_t> packTexels(const std::vector<float>& texels, FormatTraits traits) {
  std::vector<uint8_t> bytes(texels.size() / traits.channels * traits.bytesPerTexel);
  if (traits.bytesPerTexel == 1) {
    for (size_t i = 0; i < texels.size(); ++i) bytes[i] = static_cast<uint8_t>(std::lround(texels[i] * 255.0f));
    return bytes;
  }
  if (traits.bytesPerTexel == traits.channels * sizeof(uint16_t) && !traits.isDepth()) {
    for (size_t i = 0; i < texels.size(); ++i) {
      const uint16_t half = glm::packHalf1x16(texels[i]);
      std::memcpy(bytes.data() + i * sizeof(half), &half, sizeof(half));
    }
    return bytes;
  }
  if (!traits.isDepth() || traits.bytesPerTexel != sizeof(uint16_t)) {
    std::memcpy(bytes.data(), texels.data(), bytes.size());
    return bytes;
  }
  for (size_t i = 0; i < texels.size(); ++i) {
    const auto code = static_cast<uint16_t>(std::lround(texels[i] * 65535.0f));
    std::memcpy(bytes.data() + i * sizeof(code), &code, sizeof(code));
  }
  return bytes;
}

std::vector<float> widenTexels(const void* texels, size_t byteCount, FormatTraits traits) {
  std::vector<float> values(byteCount / traits.bytesPerTexel * traits.channels);
  if (traits.bytesPerTexel == traits.channels * sizeof(float)) {
    std::memcpy(values.data(), texels, byteCount);
    return values;
  }
  if (traits.bytesPerTexel == 1) {
    const auto* bytes = static_cast<const uint8_t*>(texels);
    for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(bytes[i]) / 255.0f;
    return values;
  }
  const auto* codes = static_cast<const uint16_t*>(texels);
  for (size_t i = 0; i < values.size(); ++i) {
    values[i] = traits.isDepth() ? static_cast<float>(codes[i]) / 65535.0f : glm::unpackHalf1x16(codes[i]);
  }
  return values;
}

Status allocateMemory(VkDevice device, const VkMemoryRequirements& requirements, uint32_t type, VkDeviceMemory& memory,
                      VkMemoryAllocateFlags flags = 0) {
  VkMemoryAllocateFlagsInfo flagsInfo{};
  flagsInfo.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
  flagsInfo.flags = flags;
  VkMemoryAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  info.pNext = &flagsInfo;
  info.allocationSize = requirements.size;
  info.memoryTypeIndex = type;
  const VkResult code =
      type == UINT32_MAX ? VK_ERROR_OUT_OF_DEVICE_MEMORY : vkAllocateMemory(device, &info, nullptr, &memory);
  if (code != VK_SUCCESS) {
    return makeError(ErrorKind::kUnsupported, "host: allocating %llu bytes gives VkResult %d",
                     static_cast<unsigned long long>(requirements.size), code);
  }
  return {};
}

void copyToBuffer(VkCommandBuffer commands, const HostImage& image, uint32_t layer, FormatTraits traits,
                  VkBuffer buffer) {
  VkBufferImageCopy region{};
  region.imageSubresource = {traits.aspect(), 0, layer, 1};
  region.imageExtent = {image.extent.width, image.extent.height, 1};
  vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_GENERAL, buffer, 1, &region);
  recordMemoryBarrier(commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

// Into layout GENERAL, whatever it held before.
void copyToImage(VkCommandBuffer commands, VkBuffer buffer, const HostImage& image, FormatTraits traits) {
  VkImageMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image.image;
  barrier.subresourceRange = {traits.aspects, 0, 1, 0, 1};
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.imageMemoryBarrierCount = 1;
  dependency.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
  VkBufferImageCopy region{};
  region.imageSubresource = {traits.aspect(), 0, 0, 1};
  region.imageExtent = {image.extent.width, image.extent.height, 1};
  vkCmdCopyBufferToImage(commands, buffer, image.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
}

}  // namespace

void recordMemoryBarrier(VkCommandBuffer commands, VkPipelineStageFlags2 fromStage, VkAccessFlags2 fromAccess,
                         VkPipelineStageFlags2 toStage, VkAccessFlags2 toAccess) {
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
  vkCmdPipelineBarrier2(commands, &dependency);
}

uint32_t Host::State::findMemoryType(uint32_t allowedTypes, VkMemoryPropertyFlags wanted) const {
  for (uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
    if ((allowedTypes >> type & 1) && (memory.memoryTypes[type].propertyFlags & wanted) == wanted) {
      return type;
    }
  }
  return UINT32_MAX;
}

Result<HostImage> Host::createImage(VkFormat format, VkExtent2D extent, uint32_t layers) {
  const Result<FormatTraits> traits = traitsOf(format);
  if (!traits) return traits.error();
  // What every device must allow (Vulkan specification, VkImageFormatProperties::maxResourceSize); lavapipe
  // crashes above.
  constexpr uint64_t kMaxImageBytes = uint64_t{1} << 31;
  if (uint64_t{extent.width} * extent.height * traits->bytesPerTexel > kMaxImageBytes) {
    return makeError(ErrorKind::kUnsupported, "image: %u x %u pixels of %u bytes exceed 2 GiB; use a smaller size",
                     extent.width, extent.height, traits->bytesPerTexel);
  }
  HostImage image;
  image.format = format;
  image.extent = extent;
  VkImageCreateInfo imageInfo{};
  imageInfo.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  imageInfo.imageType = VK_IMAGE_TYPE_2D;
  imageInfo.format = format;
  imageInfo.extent = {extent.width, extent.height, 1};
  imageInfo.mipLevels = 1;
  imageInfo.arrayLayers = layers;
  imageInfo.samples = VK_SAMPLE_COUNT_1_BIT;
  imageInfo.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                    (traits->isDepth() ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_STORAGE_BIT);
  if (state_->usesGraphics && !traits->isDepth()) imageInfo.usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (const VkResult code = vkCreateImage(device, &imageInfo, nullptr, &image.image); code != VK_SUCCESS) {
    return makeError(ErrorKind::kUnsupported, "vkCreateImage of %u x %u gives VkResult %d", extent.width, extent.height,
                     code);
  }
  VkMemoryRequirements requirements{};
  vkGetImageMemoryRequirements(device, image.image, &requirements);
  const uint32_t type = state_->findMemoryType(requirements.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  if (const Status status = allocateMemory(device, requirements, type, image.memory); !status) {
    destroyImage(image);
    return status.error();
  }
  vkBindImageMemory(device, image.image, image.memory, 0);

  VkImageViewCreateInfo viewInfo{};
  viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  viewInfo.image = image.image;
  viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
  viewInfo.format = format;
  viewInfo.subresourceRange = {traits->aspect(), 0, 1, 0, 1};
  if (const VkResult code = vkCreateImageView(device, &viewInfo, nullptr, &image.view); code != VK_SUCCESS) {
    destroyImage(image);
    return makeError(ErrorKind::kUnsupported, "vkCreateImageView gives VkResult %d", code);
  }
  return image;
}

void Host::destroyImage(HostImage& image) {
  vkDestroyImageView(device, image.view, nullptr);
  vkDestroyImage(device, image.image, nullptr);
  vkFreeMemory(device, image.memory, nullptr);
  image = {};
}

FrothImage Host::describe(const HostImage& image) const {
  FrothImage described{};
  described.image = image.image;
  described.view = image.view;
  described.format = image.format;
  described.extent = image.extent;
  described.layoutIn = VK_IMAGE_LAYOUT_UNDEFINED;
  described.stageIn = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;  // two passes of one submission may write the same image
  described.accessIn = VK_ACCESS_2_MEMORY_WRITE_BIT;
  described.layoutOut = VK_IMAGE_LAYOUT_GENERAL;
  described.stageOut = VK_PIPELINE_STAGE_2_COPY_BIT;
  described.accessOut = VK_ACCESS_2_TRANSFER_READ_BIT;
  return described;
}

FrothImage Host::describeInput(const HostImage& image) const {
  FrothImage described = describe(image);
  described.layoutIn = VK_IMAGE_LAYOUT_GENERAL;
  return described;
}

Status Host::State::createTransferBuffer(VkDevice onDevice, VkDeviceSize bytes, VkBufferUsageFlags usage,
                                         TransferBuffer& transfer) const {
  VkBufferCreateInfo bufferInfo{};
  bufferInfo.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  bufferInfo.size = bytes;
  bufferInfo.usage = usage;
  transfer.device = onDevice;
  if (const VkResult code = vkCreateBuffer(onDevice, &bufferInfo, nullptr, &transfer.buffer); code != VK_SUCCESS) {
    return makeError(ErrorKind::kUnsupported, "vkCreateBuffer gives VkResult %d", code);
  }
  VkMemoryRequirements requirements{};
  vkGetBufferMemoryRequirements(onDevice, transfer.buffer, &requirements);
  constexpr VkMemoryPropertyFlags kCoherent =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  uint32_t type = findMemoryType(requirements.memoryTypeBits, kCoherent | VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
  if (type == UINT32_MAX) {
    type = findMemoryType(requirements.memoryTypeBits, kCoherent);
  }
  if (const Status status = allocateMemory(onDevice, requirements, type, transfer.memory); !status) {
    return status;
  }
  vkBindBufferMemory(onDevice, transfer.buffer, transfer.memory, 0);
  vkMapMemory(onDevice, transfer.memory, 0, VK_WHOLE_SIZE, 0, &transfer.mapped);
  return {};
}

Result<HostBuffer> Host::createBuffer(VkDeviceSize bytes, VkBufferUsageFlags usage) {
  VkBufferCreateInfo bufferInfo{};
  bufferInfo.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  bufferInfo.size = bytes;
  bufferInfo.usage = usage;
  HostBuffer buffer;
  if (const VkResult code = vkCreateBuffer(device, &bufferInfo, nullptr, &buffer.buffer); code != VK_SUCCESS) {
    return makeError(ErrorKind::kUnsupported, "vkCreateBuffer gives VkResult %d", code);
  }
  VkMemoryRequirements requirements{};
  vkGetBufferMemoryRequirements(device, buffer.buffer, &requirements);
  constexpr VkMemoryPropertyFlags kCoherent =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  uint32_t type = state_->findMemoryType(requirements.memoryTypeBits, kCoherent | VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  if (type == UINT32_MAX) type = state_->findMemoryType(requirements.memoryTypeBits, kCoherent);
  const bool hasAddress = (usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0;
  const VkMemoryAllocateFlags flags = hasAddress ? VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT : 0;
  if (const Status status = allocateMemory(device, requirements, type, buffer.memory, flags); !status) {
    destroyBuffer(buffer);
    return status.error();
  }
  vkBindBufferMemory(device, buffer.buffer, buffer.memory, 0);
  if (hasAddress) {
    VkBufferDeviceAddressInfo addressInfo{};
    addressInfo.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    addressInfo.buffer = buffer.buffer;
    buffer.address = vkGetBufferDeviceAddress(device, &addressInfo);
  }
  vkMapMemory(device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped);
  return buffer;
}

void Host::destroyBuffer(HostBuffer& buffer) {
  vkDestroyBuffer(device, buffer.buffer, nullptr);
  vkFreeMemory(device, buffer.memory, nullptr);
  buffer = {};
}

Result<std::vector<float>> Host::readImage(const HostImage& image, uint32_t layer) {
  const Result<FormatTraits> traits = traitsOf(image.format);
  if (!traits) {
    return traits.error();
  }
  const VkDeviceSize bytes = VkDeviceSize{image.extent.width} * image.extent.height * traits->bytesPerTexel;
  TransferBuffer readback;
  if (const Status status = state_->createTransferBuffer(device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, readback);
      !status) {
    return status.error();
  }
  const Status status = state_->runCommands(device, queue, [&](VkCommandBuffer commands) {
    copyToBuffer(commands, image, layer, *traits, readback.buffer);
    return Status();
  });
  if (!status) {
    return status.error();
  }
  return widenTexels(readback.mapped, bytes, *traits);
}

Status Host::writeImage(const HostImage& image, const std::vector<float>& texels) {
  const Result<FormatTraits> traits = traitsOf(image.format);
  if (!traits || texels.size() != size_t{image.extent.width} * image.extent.height * traits->channels) {
    return makeError(ErrorKind::kUsage, "image of %u x %u texels: %zu floats do not fill it", image.extent.width,
                     image.extent.height, texels.size());
  }
  const std::vector<uint8_t> bytes = packTexels(texels, *traits);
  TransferBuffer upload;
  if (const Status status =
          state_->createTransferBuffer(device, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, upload);
      !status) {
    return status;
  }
  std::memcpy(upload.mapped, bytes.data(), bytes.size());
  return state_->runCommands(device, queue, [&](VkCommandBuffer commands) {
    copyToImage(commands, upload.buffer, image, *traits);
    return Status();
  });
}

}  // namespace froth
