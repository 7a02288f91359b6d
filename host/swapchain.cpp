#include "host/swapchain.h"

#include <algorithm>

#include "host/vulkan_check.h"

namespace froth {

Status Swapchain::chooseFormat() {
  VkBool32 canPresent = VK_FALSE;
  vkGetPhysicalDeviceSurfaceSupportKHR(host_.physicalDevice, host_.queueFamily, surface_, &canPresent);
  if (!canPresent) {
    return makeError(ErrorKind::kUnsupported,
                     "device %s cannot present to this window; pick another with --device, or use --headless",
                     host_.info.name.c_str());
  }
  uint32_t count = 0;
  vkGetPhysicalDeviceSurfaceFormatsKHR(host_.physicalDevice, surface_, &count, nullptr);
  std::vector<VkSurfaceFormatKHR> formats(count);
  vkGetPhysicalDeviceSurfaceFormatsKHR(host_.physicalDevice, surface_, &count, formats.data());
  // Froth's colour is linear; an sRGB format makes the hardware encode it on the way to the screen.
  const auto found = std::find_if(formats.begin(), formats.end(), [](const VkSurfaceFormatKHR& offered) {
    return offered.format == VK_FORMAT_B8G8R8A8_SRGB || offered.format == VK_FORMAT_R8G8B8A8_SRGB;
  });
  if (found == formats.end()) {
    return makeError(ErrorKind::kUnsupported, "device %s offers no 8-bit sRGB format for this window; use --headless",
                     host_.info.name.c_str());
  }
  surfaceFormat_ = *found;
  return {};
}

Status Swapchain::resize(VkExtent2D windowExtent) {
  VkSurfaceCapabilitiesKHR capabilities{};
  vkGetPhysicalDeviceSurfaceCapabilitiesKHR(host_.physicalDevice, surface_, &capabilities);
  // Most systems dictate the size; 2^32 - 1 means that the window takes the swapchain's.
  extent_ = capabilities.currentExtent.width != UINT32_MAX ? capabilities.currentExtent : windowExtent;

  VkSwapchainCreateInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
  info.surface = surface_;
  info.minImageCount = capabilities.minImageCount + 1;
  if (capabilities.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, capabilities.maxImageCount);
  info.imageFormat = surfaceFormat_.format;
  info.imageColorSpace = surfaceFormat_.colorSpace;
  info.imageExtent = extent_;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  info.preTransform = capabilities.currentTransform;
  info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  info.presentMode = VK_PRESENT_MODE_FIFO_KHR;  // the only one that is always there
  info.clipped = VK_TRUE;
  info.oldSwapchain = swapchain_;
  VkSwapchainKHR made = VK_NULL_HANDLE;
  const VkResult result = vkCreateSwapchainKHR(host_.device, &info, nullptr, &made);
  destroy();
  swapchain_ = made;
  if (Status status = checkVulkan(result, "vkCreateSwapchainKHR"); !status) return status;

  uint32_t count = 0;
  vkGetSwapchainImagesKHR(host_.device, swapchain_, &count, nullptr);
  std::vector<VkImage> handles(count);
  vkGetSwapchainImagesKHR(host_.device, swapchain_, &count, handles.data());
  for (const VkImage handle : handles) {
    SwapchainImage& image = images_.emplace_back();
    image.image = handle;
    VkImageViewCreateInfo viewInfo{};
    viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    viewInfo.image = handle;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = surfaceFormat_.format;
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    Status status = checkVulkan(vkCreateImageView(host_.device, &viewInfo, nullptr, &image.view), "vkCreateImageView");
    if (!status) return status;
    const VkSemaphoreCreateInfo semaphoreInfo{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, nullptr, 0};
    status = checkVulkan(vkCreateSemaphore(host_.device, &semaphoreInfo, nullptr, &image.isDrawn), "vkCreateSemaphore");
    if (!status) return status;
  }
  return {};
}

void Swapchain::destroy() {
  for (const SwapchainImage& image : images_) {
    vkDestroySemaphore(host_.device, image.isDrawn, nullptr);
    vkDestroyImageView(host_.device, image.view, nullptr);
  }
  images_.clear();
  vkDestroySwapchainKHR(host_.device, swapchain_, nullptr);
  swapchain_ = VK_NULL_HANDLE;
}

}  // namespace froth
