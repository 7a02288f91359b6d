// The caller's images as the passes see them: descriptor sets, placeholders for images that are not wanted,
// barriers.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "froth/froth.h"
#include "runtime/device/pipeline_objects.h"
#include "runtime/render/frame_images.h"

namespace froth {

class OutputImages {
 public:
  // recordings: how many can be in flight; each has a descriptor set of its own.
  static Result<std::unique_ptr<OutputImages>> create(Device& device, uint32_t recordings);
  ~OutputImages();

  // Points the recording's set to the wanted images. The recording before it with this number must be
  // complete.
  VkDescriptorSet update(uint32_t recording, const FrothRenderInfo& info);

  // Orders everything before after the caller's use of the images, and all passes after earlier frames' use
  // of the view.
  void enter(VkCommandBuffer commandBuffer, const FrothRenderInfo& info) const;
  // Hands the images on in their exit states.
  void leave(VkCommandBuffer commandBuffer, const FrothRenderInfo& info) const;

 private:
  // One texel in layout GENERAL that stands where a pipeline needs a valid descriptor; neither written nor read.
  struct Placeholder {
    VkFormat format;
    VkImageUsageFlags usage;
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;  // in their memory
  };

  explicit OutputImages(Device& device) : device_(device) {}
  std::array<Placeholder*, 3> placeholders() { return {&half4_, &float1_, &input_}; }
  const Placeholder& placeholderOf(const FrameImage& image) const;
  Status createPlaceholders();
  Status createImage(Placeholder& placeholder, VkMemoryRequirements& all);
  Status bindImage(Placeholder& placeholder);

  Device& device_;
  std::unique_ptr<DescriptorSets> sets_;
  Placeholder half4_{VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_STORAGE_BIT};  // colour, normal
  Placeholder float1_{VK_FORMAT_R32_SFLOAT, VK_IMAGE_USAGE_STORAGE_BIT};          // distance, depth
  Placeholder input_{VK_FORMAT_R32_SFLOAT, VK_IMAGE_USAGE_SAMPLED_BIT};  // what is read is never one that is written
  MemoryBlock memory_;                                                   // of all three
};

}  // namespace froth
