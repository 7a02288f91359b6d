// What Froth draws into, and what Qt shows.
#pragma once

#include <memory>

#include <vulkan/vulkan.h>

#include "base/result.h"
#include "froth/froth.h"

namespace froth {

// Froth writes halves; QSGVulkanTexture::fromNative takes RGBA8 alone. A blit rounds one to the other. One pair serves
// all frames in flight: a frame's barriers make it wait until the one before has read them.
class FoamImages {
 public:
  static Result<std::unique_ptr<FoamImages>> create(VkPhysicalDevice physicalDevice, VkDevice device,
                                                    VkExtent2D extent);
  ~FoamImages();  // all frames that use them are complete
  FoamImages(const FoamImages&) = delete;
  FoamImages& operator=(const FoamImages&) = delete;

  FrothImage drawn() const;                         // for FrothRenderInfo::colour
  void recordCopy(VkCommandBuffer commands) const;  // from drawn() to shown()
  VkImage shown() const { return shown_.image; }    // in layout SHADER_READ_ONLY_OPTIMAL, for fragment shaders
  VkExtent2D extent() const { return extent_; }

 private:
  struct Texels {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
  };
  FoamImages(VkDevice device, VkExtent2D extent) : device_(device), extent_(extent) {}
  Status createTexels(VkPhysicalDevice physicalDevice, VkFormat format, VkImageUsageFlags usage, Texels& texels);
  Status createView();

  VkDevice device_;
  VkExtent2D extent_;
  Texels drawn_, shown_;
  VkImageView drawnView_ = VK_NULL_HANDLE;
};

}  // namespace froth
