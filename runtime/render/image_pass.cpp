#include "runtime/render/image_pass.h"

#include <cstddef>

namespace froth {

Result<std::unique_ptr<ImagePass>> ImagePass::create(Device& device, VkPipelineCache cache, const ImagePassCode& code) {
  std::unique_ptr<ImagePass> pass(new ImagePass(device));
  const Result<VkDescriptorSetLayout> setLayout = createSetLayout(device, code.name, code.bindings);
  if (!setLayout) return setLayout.error();
  pass->setLayout_ = *setLayout;
  const Result<VkPipelineLayout> layout = createPipelineLayout(device, code.name, pass->setLayout_, code.pushBytes);
  if (!layout) return layout.error();
  pass->layout_ = *layout;
  const Result<VkPipeline> pipeline =
      createComputePipeline(device, cache, code.name, code.spirv, nullptr, pass->layout_);
  if (!pipeline) return pipeline.error();
  pass->pipeline_ = *pipeline;
  return pass;
}

ImagePass::~ImagePass() {
  const DeviceTable& vk = device_.table;
  vk.vkDestroyPipeline(device_.device, pipeline_, nullptr);
  vk.vkDestroyPipelineLayout(device_.device, layout_, nullptr);
  vk.vkDestroyDescriptorSetLayout(device_.device, setLayout_, nullptr);
}

void ImagePass::bind(VkCommandBuffer commandBuffer, VkDescriptorSet set, std::span<const std::byte> push) const {
  const DeviceTable& vk = device_.table;
  vk.vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
  vk.vkCmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set, 0, nullptr);
  vk.vkCmdPushConstants(commandBuffer, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, static_cast<uint32_t>(push.size()),
                        push.data());
}

}  // namespace froth
