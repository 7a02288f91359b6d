// A pipeline of an engine that uses a walk set: its set 0, and push constants for all its stages.
#pragma once

#include <span>

#include "froth/froth_walk.h"
#include "host/host.h"

namespace froth::test {

class EnginePipeline {
 public:
  // prepared: its constant_id 0.
  EnginePipeline(FrothContext* context, std::span<const uint32_t> computeSpirv, uint32_t constantBytes,
                 FrothRayPreparation prepared);
  // Draws a triangle into a picture of its own, of four floats per pixel.
  EnginePipeline(FrothContext* context, std::span<const uint32_t> vertexSpirv, std::span<const uint32_t> fragmentSpirv,
                 uint32_t constantBytes, VkExtent2D extent);
  ~EnginePipeline();
  EnginePipeline(const EnginePipeline&) = delete;

  void bind(VkCommandBuffer commands, VkDescriptorSet set, const void* constants) const;
  void draw(VkCommandBuffer commands, VkDescriptorSet set, const void* constants) const;
  const HostImage& picture() const { return picture_; }

 private:
  EnginePipeline(FrothContext* context, VkShaderStageFlags stages, uint32_t constantBytes);
  void createPicture(VkExtent2D extent);
  void createRenderPass();
  void createGraphicsPipeline(std::span<const uint32_t> vertexSpirv, std::span<const uint32_t> fragmentSpirv);

  VkShaderStageFlags stages_;
  uint32_t constantBytes_;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  HostImage picture_;
  VkRenderPass renderPass_ = VK_NULL_HANDLE;
  VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
};

}  // namespace froth::test
