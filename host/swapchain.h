// The images of a window.
#pragma once

#include <vector>

#include "host/host.h"

namespace froth {

struct SwapchainImage {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkSemaphore isDrawn = VK_NULL_HANDLE;  // the presentation waits for it
};

class Swapchain {
 public:
  // `surface` stays the caller's.
  Swapchain(const Host& host, VkSurfaceKHR surface) : host_(host), surface_(surface) {}
  ~Swapchain() { destroy(); }
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  // Fails if the device cannot present to the surface.
  Status chooseFormat();
  // (Re)makes the images for a window of this size; the device is done with the old ones.
  Status resize(VkExtent2D windowExtent);

  VkFormat format() const { return surfaceFormat_.format; }
  VkExtent2D extent() const { return extent_; }
  VkSwapchainKHR handle() const { return swapchain_; }
  const std::vector<SwapchainImage>& images() const { return images_; }

 private:
  void destroy();

  const Host& host_;
  VkSurfaceKHR surface_;
  VkSurfaceFormatKHR surfaceFormat_{};
  VkExtent2D extent_{};
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  std::vector<SwapchainImage> images_;
};

}  // namespace froth
