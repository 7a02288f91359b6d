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
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  const VkResult result = device.table.vkCreateDescriptorSetLayout(device.device, &info, nullptr, &layout);
  if (result != VK_SUCCESS) {
    return device.explain(result, "%s: vkCreateDescriptorSetLayout", name);
  }
  return layout;
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
  VkPipelineLayout layout = VK_NULL_HANDLE;
  const VkResult result = device.table.vkCreatePipelineLayout(device.device, &info, nullptr, &layout);
  if (result != VK_SUCCESS) {
    return device.explain(result, "%s: vkCreatePipelineLayout", name);
  }
  return layout;
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
  return pipeline;
}

}  // namespace froth
