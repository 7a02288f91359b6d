#include "runtime/render/image_barriers.h"

namespace froth {
namespace {

constexpr VkAccessFlags2 kWrites =
    VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

VkImageAspectFlags aspectOf(VkFormat format) {
  switch (format) {
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
      return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
      return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
      return VK_IMAGE_ASPECT_COLOR_BIT;
  }
}

}  // namespace

VkImageMemoryBarrier2 barrierOf(VkImage image) {
  VkImageMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  return barrier;
}

VkImageMemoryBarrier2 entryBarrier(const FrothImage& image, const ImageUse& use) {
  VkImageMemoryBarrier2 barrier = barrierOf(image.image);
  barrier.subresourceRange.aspectMask = aspectOf(image.format);
  barrier.subresourceRange.baseArrayLayer = image.layer;
  barrier.srcStageMask = image.stageIn;
  barrier.srcAccessMask = image.accessIn;
  barrier.oldLayout = image.layoutIn;
  barrier.dstStageMask = use.stage;
  barrier.dstAccessMask = use.access;
  barrier.newLayout = use.layout;
  return barrier;
}

VkImageMemoryBarrier2 exitBarrier(const FrothImage& image, const ImageUse& use) {
  VkImageMemoryBarrier2 barrier = barrierOf(image.image);
  barrier.subresourceRange.aspectMask = aspectOf(image.format);
  barrier.subresourceRange.baseArrayLayer = image.layer;
  barrier.srcStageMask = use.stage;
  barrier.srcAccessMask = use.access & kWrites;
  barrier.oldLayout = use.layout;
  barrier.dstStageMask = image.stageOut;
  barrier.dstAccessMask = image.accessOut;
  barrier.newLayout = image.layoutOut;
  return barrier;
}

}  // namespace froth
