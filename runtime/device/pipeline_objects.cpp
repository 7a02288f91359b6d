#include "runtime/device/pipeline_objects.h"

namespace froth {

Result<VkDescriptorSetLayout> createSetLayout(Device& device, const char* name, const SetBindings& given) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const VkDescriptorType type : given.types) {
    bindings.push_back({static_cast<uint32_t>(bindings.size()), type, 1, given.stages, nullptr});
  }
  VkDescriptorSetLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  info.bindingCount = static_cast<uint32_t>(bindings.size());
  info.pBindings = bindings.data();
  return device.create(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, name, device.table.vkCreateDescriptorSetLayout, info);
}

Result<VkPipelineLayout> createPipelineLayout(Device& device, const char* name, VkDescriptorSetLayout set,
                                              uint32_t pushBytes) {
  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = 1;
  info.pSetLayouts = &set;
  info.pushConstantRangeCount = pushBytes > 0 ? 1 : 0;
  info.pPushConstantRanges = &range;
  return device.create(VK_OBJECT_TYPE_PIPELINE_LAYOUT, name, device.table.vkCreatePipelineLayout, info);
}

Result<std::unique_ptr<DescriptorSets>> DescriptorSets::create(Device& device, const char* name,
                                                               const SetBindings& bindings, uint32_t count) {
  std::unique_ptr<DescriptorSets> made(new DescriptorSets(device));
  made->bindings_ = bindings;
  const Result<VkDescriptorSetLayout> layout = createSetLayout(device, name, bindings);
  if (!layout) return layout.error();
  made->layout_ = *layout;
  std::vector<VkDescriptorPoolSize> sizes;
  for (const VkDescriptorType type : bindings.types) sizes.push_back({type, count});
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = count;
  info.poolSizeCount = static_cast<uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  const Result<VkDescriptorPool> pool =
      device.create(VK_OBJECT_TYPE_DESCRIPTOR_POOL, name, device.table.vkCreateDescriptorPool, info);
  if (!pool) return pool.error();
  made->pool_ = *pool;

  const std::vector<VkDescriptorSetLayout> layouts(count, made->layout_);
  VkDescriptorSetAllocateInfo allocation{};
  allocation.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  allocation.descriptorPool = made->pool_;
  allocation.descriptorSetCount = count;
  allocation.pSetLayouts = layouts.data();
  made->sets_.resize(count);
  const VkResult result = device.table.vkAllocateDescriptorSets(device.device, &allocation, made->sets_.data());
  if (result != VK_SUCCESS) return device.explain(result, "%s: vkAllocateDescriptorSets", name);
  for (const VkDescriptorSet set : made->sets_) device.nameObject(VK_OBJECT_TYPE_DESCRIPTOR_SET, set, name);
  return made;
}

DescriptorSets::~DescriptorSets() {
  device_.table.vkDestroyDescriptorPool(device_.device, pool_, nullptr);
  device_.table.vkDestroyDescriptorSetLayout(device_.device, layout_, nullptr);
}

VkDescriptorSet DescriptorSets::update(uint32_t index, std::span<const VkDescriptorImageInfo> images) const {
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

Result<VkPipeline> createComputePipeline(Device& device, VkPipelineCache cache, const char* name,
                                         std::span<const uint32_t> spirv, const VkSpecializationInfo* specialization,
                                         VkPipelineLayout layout) {
  const Result<VkShaderModule> shader = device.createShaderModule(name, spirv);
  if (!shader) {
    return shader.error();
  }
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = *shader;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = specialization;
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result = device.table.vkCreateComputePipelines(device.device, cache, 1, &info, nullptr, &pipeline);
  device.table.vkDestroyShaderModule(device.device, *shader, nullptr);
  if (result != VK_SUCCESS) {
    return device.explain(result, "%s: vkCreateComputePipelines", name);
  }
  device.nameObject(VK_OBJECT_TYPE_PIPELINE, pipeline, name);
  return pipeline;
}

}  // namespace froth
