// Turns a picture into its difference from another one, on the GPU.
#pragma once

#include <memory>

#include "samples/host/host.h"

namespace froth {

class DifferencePass {
 public:
  // Two images of one size, R16G16B16A16_SFLOAT with STORAGE usage; they outlive the pass.
  static Result<std::unique_ptr<DifferencePass>> create(const Host& host, const HostImage& picture,
                                                        const HostImage& other);
  ~DifferencePass();

  // Both images are in layout GENERAL, ready to be read and written by compute shaders.
  void record(VkCommandBuffer commands) const;

 private:
  DifferencePass(VkDevice device, VkExtent2D extent) : device_(device), extent_(extent) {}
  Status createPipeline();
  Status createSet(const HostImage& picture, const HostImage& other);

  VkDevice device_;
  VkExtent2D extent_;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace froth
