// Small passes over whole images, each with a pipeline and descriptor sets of its own: no pass of Froth relies on more
// than the four storage images that every device can bind at once.
#pragma once

#include <initializer_list>
#include <memory>
#include <span>

#include "runtime/device/pipeline_objects.h"

namespace froth {

struct ImagePassCode {
  const char* name;
  std::span<const uint32_t> spirv;
  SetBindings bindings;
  uint32_t pushBytes;
};

class ImagePass {
 public:
  static Result<std::unique_ptr<ImagePass>> create(Device& device, VkPipelineCache cache, const ImagePassCode& code);
  ~ImagePass();

  // Binds pipeline, set and push constants; the caller dispatches.
  void bind(VkCommandBuffer commandBuffer, VkDescriptorSet set, std::span<const std::byte> push) const;

 private:
  explicit ImagePass(Device& device) : device_(device) {}

  Device& device_;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
};

}  // namespace froth
