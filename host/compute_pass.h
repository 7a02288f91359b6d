// One compute shader with the images and buffers that it works on.
#pragma once

#include <memory>
#include <span>

#include "host/host.h"

namespace froth {

// Binding i of set 0 is resource i.
struct PassResource {
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  VkImageView image = VK_NULL_HANDLE;  // in `layout` when the pass runs; or
  VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL;
  VkBuffer buffer = VK_NULL_HANDLE;
};

PassResource storageImage(const HostImage& image);  // in GENERAL
PassResource sampledImage(const HostImage& image);  // in SHADER_READ_ONLY_OPTIMAL; read by texelFetch alone
PassResource uniformBuffer(VkBuffer buffer);
PassResource storageBuffer(VkBuffer buffer);

class ComputePass {
 public:
  // Resources, and the layout of a set 1 if there is one, outlive the pass. constants: constant_id 0...
  static Result<std::unique_ptr<ComputePass>> create(const Host& host, std::span<const uint32_t> spirv,
                                                     std::span<const PassResource> resources,
                                                     VkDescriptorSetLayout secondLayout = VK_NULL_HANDLE,
                                                     std::span<const uint32_t> constants = {});
  ~ComputePass();
  ComputePass(const ComputePass&) = delete;
  ComputePass& operator=(const ComputePass&) = delete;

  // One thread per pixel, in workgroups of 8 x 8.
  void record(VkCommandBuffer commands, VkExtent2D extent, VkDescriptorSet secondSet = VK_NULL_HANDLE) const;

 private:
  explicit ComputePass(VkDevice device) : device_(device) {}
  Status createPipeline(std::span<const uint32_t> spirv, std::span<const PassResource> resources,
                        VkDescriptorSetLayout secondLayout, std::span<const uint32_t> constants);
  Status createSet(std::span<const PassResource> resources);

  VkDevice device_;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace froth
