#include "samples/qt_quick/foam_images.h"

#include "host/vulkan_check.h"

namespace froth {
namespace {

constexpr VkFormat kDrawnFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat kShownFormat = VK_FORMAT_R8G8B8A8_UNORM;

uint32_t findDeviceLocal(VkPhysicalDevice physicalDevice, uint32_t typeBits) {
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(physicalDevice, &memory);
  for (uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
    const bool isLocal = (memory.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) != 0;
    if ((typeBits >> type & 1) != 0 && isLocal) return type;
  }
  return 0;  // not reached: Vulkan lets every image of optimal tiling lie in device-local memory
}

}  // namespace

Result<std::unique_ptr<FoamImages>> FoamImages::create(VkPhysicalDevice physicalDevice, VkDevice device,
                                                       VkExtent2D extent) {
  std::unique_ptr<FoamImages> images(new FoamImages(device, extent));
  Status made = images->createTexels(physicalDevice, kDrawnFormat,
                                     VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, images->drawn_);
  if (!made) return made.error();
  made = images->createTexels(physicalDevice, kShownFormat,
                              VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, images->shown_);
  if (!made) return made.error();
  if (made = images->createView(); !made) return made.error();
  return images;
}

FoamImages::~FoamImages() {
  vkDestroyImageView(device_, drawnView_, nullptr);
  for (const Texels& texels : {drawn_, shown_}) {
    vkDestroyImage(device_, texels.image, nullptr);
    vkFreeMemory(device_, texels.memory, nullptr);
  }
}

Status FoamImages::createTexels(VkPhysicalDevice physicalDevice, VkFormat format, VkImageUsageFlags usage,
                                Texels& texels) {
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {extent_.width, extent_.height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = usage;
  Status made = checkVulkan(vkCreateImage(device_, &info, nullptr, &texels.image), "vkCreateImage");
  if (!made) return made;
  VkMemoryRequirements needed{};
  vkGetImageMemoryRequirements(device_, texels.image, &needed);
  VkMemoryAllocateInfo memory{};
  memory.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  memory.allocationSize = needed.size;
  memory.memoryTypeIndex = findDeviceLocal(physicalDevice, needed.memoryTypeBits);
  made = checkVulkan(vkAllocateMemory(device_, &memory, nullptr, &texels.memory), "vkAllocateMemory");
  if (!made) return made;
  return checkVulkan(vkBindImageMemory(device_, texels.image, texels.memory, 0), "vkBindImageMemory");
}

Status FoamImages::createView() {
  VkImageViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  info.image = drawn_.image;
  info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  info.format = kDrawnFormat;
  info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  return checkVulkan(vkCreateImageView(device_, &info, nullptr, &drawnView_), "vkCreateImageView");
}

FrothImage FoamImages::drawn() const {
  FrothImage image{};
  image.image = drawn_.image;
  image.view = drawnView_;
  image.format = kDrawnFormat;
  image.extent = extent_;
  image.layoutIn = VK_IMAGE_LAYOUT_UNDEFINED;  // once the frame before has copied it
  image.layoutOut = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  image.stageIn = image.stageOut = VK_PIPELINE_STAGE_2_BLIT_BIT;
  image.accessOut = VK_ACCESS_2_TRANSFER_READ_BIT;
  return image;
}

void FoamImages::recordCopy(VkCommandBuffer commands) const {
  const ImageUse sampled{VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                         VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
  const ImageUse written{VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_BLIT_BIT,
                         VK_ACCESS_2_TRANSFER_WRITE_BIT};
  const ImageUse discarded{VK_IMAGE_LAYOUT_UNDEFINED, sampled.stage, VK_ACCESS_2_NONE};
  imageBarrier(commands, shown_.image, discarded, written);
  VkImageBlit blit{};
  blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  blit.srcOffsets[1] =
      blit.dstOffsets[1] = {static_cast<int32_t>(extent_.width), static_cast<int32_t>(extent_.height), 1};
  vkCmdBlitImage(commands, drawn_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, shown_.image,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_NEAREST);
  imageBarrier(commands, shown_.image, written, sampled);
}

}  // namespace froth
