#include "samples/flythrough/difference_pass.h"

#include <cstdint>

#include "samples/flythrough/vulkan_check.h"

namespace froth {
namespace {

#include "difference.comp.h"  // kDifferenceShader, made from difference.comp

constexpr uint32_t kTile = 8;  // local_size of the shader
constexpr uint32_t kImageCount = 2;

}  // namespace

Result<std::unique_ptr<DifferencePass>> DifferencePass::create(const Host& host, const HostImage& picture,
                                                               const HostImage& other) {
  std::unique_ptr<DifferencePass> pass(new DifferencePass(host.device, picture.extent));
  if (Status made = pass->createPipeline(); !made) return made.error();
  if (Status made = pass->createSet(picture, other); !made) return made.error();
  return pass;
}

DifferencePass::~DifferencePass() {
  vkDestroyDescriptorPool(device_, pool_, nullptr);
  vkDestroyPipeline(device_, pipeline_, nullptr);
  vkDestroyPipelineLayout(device_, layout_, nullptr);
  vkDestroyDescriptorSetLayout(device_, setLayout_, nullptr);
}

Status DifferencePass::createPipeline() {
  VkDescriptorSetLayoutBinding bindings[kImageCount]{};
  for (uint32_t i = 0; i < kImageCount; ++i) {
    bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  }
  VkDescriptorSetLayoutCreateInfo setInfo{};
  setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  setInfo.bindingCount = kImageCount;
  setInfo.pBindings = bindings;
  Status made = checkVulkan(vkCreateDescriptorSetLayout(device_, &setInfo, nullptr, &setLayout_),
                            "vkCreateDescriptorSetLayout");
  if (!made) return made;
  VkPipelineLayoutCreateInfo layoutInfo{};
  layoutInfo.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  layoutInfo.setLayoutCount = 1;
  layoutInfo.pSetLayouts = &setLayout_;
  made =
      checkVulkan(vkCreatePipelineLayout(device_, &layoutInfo, nullptr, &layout_), "vkCreatePipelineLayout");
  if (!made) return made;

  VkShaderModuleCreateInfo moduleInfo{};
  moduleInfo.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  moduleInfo.codeSize = sizeof(kDifferenceShader);
  moduleInfo.pCode = kDifferenceShader;
  VkShaderModule module = VK_NULL_HANDLE;
  made = checkVulkan(vkCreateShaderModule(device_, &moduleInfo, nullptr, &module), "vkCreateShaderModule");
  if (!made) return made;
  VkComputePipelineCreateInfo pipelineInfo{};
  pipelineInfo.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  pipelineInfo.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  pipelineInfo.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  pipelineInfo.stage.module = module;
  pipelineInfo.stage.pName = "main";
  pipelineInfo.layout = layout_;
  made = checkVulkan(vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &pipelineInfo, nullptr, &pipeline_),
                     "vkCreateComputePipelines");
  vkDestroyShaderModule(device_, module, nullptr);
  return made;
}

Status DifferencePass::createSet(const HostImage& picture, const HostImage& other) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kImageCount};
  VkDescriptorPoolCreateInfo poolInfo{};
  poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  poolInfo.maxSets = 1;
  poolInfo.poolSizeCount = 1;
  poolInfo.pPoolSizes = &size;
  Status made =
      checkVulkan(vkCreateDescriptorPool(device_, &poolInfo, nullptr, &pool_), "vkCreateDescriptorPool");
  if (!made) return made;
  VkDescriptorSetAllocateInfo setInfo{};
  setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  setInfo.descriptorPool = pool_;
  setInfo.descriptorSetCount = 1;
  setInfo.pSetLayouts = &setLayout_;
  made = checkVulkan(vkAllocateDescriptorSets(device_, &setInfo, &set_), "vkAllocateDescriptorSets");
  if (!made) return made;

  const VkDescriptorImageInfo images[kImageCount] = {{VK_NULL_HANDLE, picture.view, VK_IMAGE_LAYOUT_GENERAL},
                                                     {VK_NULL_HANDLE, other.view, VK_IMAGE_LAYOUT_GENERAL}};
  VkWriteDescriptorSet write{};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  write.dstSet = set_;
  write.descriptorCount = kImageCount;  // runs on into binding 1
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  write.pImageInfo = images;
  vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
  return {};
}

void DifferencePass::record(VkCommandBuffer commands) const {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set_, 0, nullptr);
  vkCmdDispatch(commands, (extent_.width + kTile - 1) / kTile, (extent_.height + kTile - 1) / kTile, 1);
}

}  // namespace froth
