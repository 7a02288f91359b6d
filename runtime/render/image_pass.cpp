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

Result<std::unique_ptr<ImageSets>> ImageSets::create(Device& device, const SetBindings& bindings, uint32_t count) {
  std::unique_ptr<ImageSets> made(new ImageSets(device));
  made->bindings_ = bindings;
  const DeviceTable& vk = device.table;
  const Result<VkDescriptorSetLayout> layout = createSetLayout(device, "image sets of a view", bindings);
  if (!layout) return layout.error();
  made->layout_ = *layout;
  std::vector<VkDescriptorPoolSize> sizes;
  for (const VkDescriptorType type : bindings.types) sizes.push_back({type, count});
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = count;
  info.poolSizeCount = static_cast<uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  VkResult result = vk.vkCreateDescriptorPool(device.device, &info, nullptr, &made->pool_);
  if (result != VK_SUCCESS) return device.explain(result, "image sets of a view: vkCreateDescriptorPool");

  const std::vector<VkDescriptorSetLayout> layouts(count, made->layout_);
  VkDescriptorSetAllocateInfo allocation{};
  allocation.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  allocation.descriptorPool = made->pool_;
  allocation.descriptorSetCount = count;
  allocation.pSetLayouts = layouts.data();
  made->sets_.resize(count);
  result = vk.vkAllocateDescriptorSets(device.device, &allocation, made->sets_.data());
  if (result != VK_SUCCESS) return device.explain(result, "image sets of a view: vkAllocateDescriptorSets");
  return made;
}

ImageSets::~ImageSets() {
  device_.table.vkDestroyDescriptorPool(device_.device, pool_, nullptr);
  device_.table.vkDestroyDescriptorSetLayout(device_.device, layout_, nullptr);
}

VkDescriptorSet ImageSets::update(uint32_t index, std::span<const VkDescriptorImageInfo> images) const {
  VkWriteDescriptorSet write{};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  write.dstSet = sets_[index];
  write.descriptorCount = 1;
  for (uint32_t binding = 0; binding < images.size(); ++binding) {
    write.dstBinding = binding;
    write.descriptorType = bindings_.types[binding];
    write.pImageInfo = &images[binding];
    device_.table.vkUpdateDescriptorSets(device_.device, 1, &write, 0, nullptr);
  }
  return sets_[index];
}

}  // namespace froth
