// Device depth from an image into the engine's depth attachment: the one thing that Froth draws.
#pragma once

#include "froth/froth_composite.h"
#include "runtime/render/image_pass.h"

namespace froth {

class DepthExport {
 public:
  static SetBindings bindings();

  // format: of the attachment.
  static Result<std::unique_ptr<DepthExport>> create(Device& device, VkPipelineCache cache, VkFormat format);
  ~DepthExport();

  // info has been checked. region: what was drawn. set: one of bindings(), free for this frame.
  void record(VkCommandBuffer commandBuffer, VkDescriptorSet set, const FrothDepthExportInfo& info,
              const VkRect2D& region, bool isReversed) const;

 private:
  explicit DepthExport(Device& device) : device_(device) {}
  Status createLayout();
  Status createPipeline(VkPipelineCache cache, VkFormat format);
  void draw(VkCommandBuffer commandBuffer, VkDescriptorSet set, const FrothImage& attachment, const VkRect2D& region,
            bool isReversed) const;

  Device& device_;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
};

}  // namespace froth
