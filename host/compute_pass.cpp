#include "host/compute_pass.h"

#include <vector>

#include "host/vulkan_check.h"

namespace froth {

constexpr uint32_t kTile = 8;  // local_size of the shaders

PassResource storageImage(const HostImage& image) {
  return {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, image.view, VK_IMAGE_LAYOUT_GENERAL, VK_NULL_HANDLE};
}

PassResource sampledImage(const HostImage& image) {
  return {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, image.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_NULL_HANDLE};
}

PassResource uniformBuffer(VkBuffer buffer) {
  return {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED, buffer};
}

PassResource storageBuffer(VkBuffer buffer) {
  return {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED, buffer};
}

Result<std::unique_ptr<ComputePass>> ComputePass::create(const Host& host, std::span<const uint32_t> spirv,
                                                         std::span<const PassResource> resources,
                                                         VkDescriptorSetLayout secondLayout,
                                                         std::span<const uint32_t> constants) {
  std::unique_ptr<ComputePass> pass(new ComputePass(host.device));
  if (Status made = pass->createPipeline(spirv, resources, secondLayout, constants); !made) return made.error();
  if (Status made = pass->createSet(resources); !made) return made.error();
  return pass;
}

ComputePass::~ComputePass() {
  vkDestroyDescriptorPool(device_, pool_, nullptr);
  vkDestroyPipeline(device_, pipeline_, nullptr);
  vkDestroyPipelineLayout(device_, layout_, nullptr);
  vkDestroyDescriptorSetLayout(device_, setLayout_, nullptr);
}

Status ComputePass::createPipeline(std::span<const uint32_t> spirv, std::span<const PassResource> resources,
                                   VkDescriptorSetLayout secondLayout, std::span<const uint32_t> constants) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const PassResource& resource : resources) {
    bindings.push_back(
        {static_cast<uint32_t>(bindings.size()), resource.type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  }
  VkDescriptorSetLayoutCreateInfo setInfo{};
  setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  setInfo.bindingCount = static_cast<uint32_t>(bindings.size());
  setInfo.pBindings = bindings.data();
  Status made =
      checkVulkan(vkCreateDescriptorSetLayout(device_, &setInfo, nullptr, &setLayout_), "vkCreateDescriptorSetLayout");
  if (!made) return made;
  const VkDescriptorSetLayout layouts[] = {setLayout_, secondLayout};
  VkPipelineLayoutCreateInfo layoutInfo{};
  layoutInfo.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  layoutInfo.setLayoutCount = secondLayout ? 2 : 1;
  layoutInfo.pSetLayouts = layouts;
  made = checkVulkan(vkCreatePipelineLayout(device_, &layoutInfo, nullptr, &layout_), "vkCreatePipelineLayout");
  if (!made) return made;

  const Result<VkShaderModule> module = createShaderModule(device_, spirv);
  if (!module) return module.error();
  std::vector<VkSpecializationMapEntry> entries;
  for (uint32_t id = 0; id < constants.size(); ++id) {
    entries.push_back({id, static_cast<uint32_t>(id * sizeof(uint32_t)), sizeof(uint32_t)});
  }
  const VkSpecializationInfo specialization{static_cast<uint32_t>(entries.size()), entries.data(),
                                            constants.size_bytes(), constants.data()};
  VkComputePipelineCreateInfo pipelineInfo{};
  pipelineInfo.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  pipelineInfo.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  pipelineInfo.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  pipelineInfo.stage.module = *module;
  pipelineInfo.stage.pName = "main";
  pipelineInfo.stage.pSpecializationInfo = &specialization;
  pipelineInfo.layout = layout_;
  made = checkVulkan(vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &pipelineInfo, nullptr, &pipeline_),
                     "vkCreateComputePipelines");
  vkDestroyShaderModule(device_, *module, nullptr);
  return made;
}

Status ComputePass::createSet(std::span<const PassResource> resources) {
  std::vector<VkDescriptorPoolSize> sizes;
  for (const PassResource& resource : resources) sizes.push_back({resource.type, 1});
  VkDescriptorPoolCreateInfo poolInfo{};
  poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  poolInfo.maxSets = 1;
  poolInfo.poolSizeCount = static_cast<uint32_t>(sizes.size());
  poolInfo.pPoolSizes = sizes.data();
  Status made = checkVulkan(vkCreateDescriptorPool(device_, &poolInfo, nullptr, &pool_), "vkCreateDescriptorPool");
  if (!made) return made;
  VkDescriptorSetAllocateInfo setInfo{};
  setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  setInfo.descriptorPool = pool_;
  setInfo.descriptorSetCount = 1;
  setInfo.pSetLayouts = &setLayout_;
  made = checkVulkan(vkAllocateDescriptorSets(device_, &setInfo, &set_), "vkAllocateDescriptorSets");
  if (!made) return made;

  for (uint32_t binding = 0; binding < resources.size(); ++binding) {
    const PassResource& resource = resources[binding];
    const VkDescriptorImageInfo image{VK_NULL_HANDLE, resource.image, resource.layout};
    const VkDescriptorBufferInfo buffer{resource.buffer, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set_;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = resource.type;
    write.pImageInfo = &image;
    write.pBufferInfo = &buffer;
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
  }
  return {};
}

void ComputePass::record(VkCommandBuffer commands, VkExtent2D extent, VkDescriptorSet secondSet) const {
  const VkDescriptorSet sets[] = {set_, secondSet};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, secondSet ? 2 : 1, sets, 0, nullptr);
  vkCmdDispatch(commands, (extent.width + kTile - 1) / kTile, (extent.height + kTile - 1) / kTile, 1);
}

}  // namespace froth
