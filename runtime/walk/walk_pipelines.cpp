#include "runtime/walk/walk_pipelines.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "shaders/gpu/walk_layout.h"
#include "spirv/cast_rays.h"
#include "spirv/seed_entries.h"

namespace froth {
namespace {

constexpr uint32_t kPushConstantBytes = std::max(sizeof(CastConstants), sizeof(SeedConstants));

// constant_id 0, 1 of cast_rays.comp.
struct Specialization {
  VkBool32 checkIndices;
  uint32_t kind;
};

constexpr std::array<VkSpecializationMapEntry, 2> kSpecializationEntries = {{
    {0, offsetof(Specialization, checkIndices), sizeof(VkBool32)},
    {1, offsetof(Specialization, kind), sizeof(uint32_t)},
}};

}  // namespace

Result<std::unique_ptr<WalkPipelines>> WalkPipelines::create(Device& device, VkPipelineCache cache,
                                                             const WalkOptions& options) {
  std::unique_ptr<WalkPipelines> made(new WalkPipelines(device));
  Status status = made->createLayouts();
  for (uint32_t index = 0; status && index < kWalkPipelineCount; ++index) {
    status = made->createPipeline(index, cache, options);
  }
  if (!status) return status.error();
  return made;
}

WalkPipelines::~WalkPipelines() {
  const DeviceTable& vk = device_.table;
  for (const VkPipeline pipeline : pipelines_) vk.vkDestroyPipeline(device_.device, pipeline, nullptr);
  vk.vkDestroyPipelineLayout(device_.device, layout_, nullptr);
  vk.vkDestroyDescriptorSetLayout(device_.device, setLayout_, nullptr);
}

Status WalkPipelines::createLayouts() {
  const std::array<VkDescriptorSetLayoutBinding, gpu::kWalkBindingCount> bindings = {{
      {gpu::kBindingWalk, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr},
      {gpu::kBindingWalkCounters, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr},
  }};
  VkDescriptorSetLayoutCreateInfo setInfo{};
  setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  setInfo.bindingCount = static_cast<uint32_t>(bindings.size());
  setInfo.pBindings = bindings.data();
  VkResult result = device_.table.vkCreateDescriptorSetLayout(device_.device, &setInfo, nullptr, &setLayout_);
  if (result != VK_SUCCESS) return device_.explain(result, "walk sets: vkCreateDescriptorSetLayout");

  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, kPushConstantBytes};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = 1;
  info.pSetLayouts = &setLayout_;
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &range;
  result = device_.table.vkCreatePipelineLayout(device_.device, &info, nullptr, &layout_);
  if (result != VK_SUCCESS) return device_.explain(result, "walk sets: vkCreatePipelineLayout");
  return {};
}

Status WalkPipelines::createPipeline(uint32_t index, VkPipelineCache cache, const WalkOptions& options) {
  const DeviceTable& vk = device_.table;
  const bool isSeed = index == kSeedPipeline;
  const char* name = isSeed ? "seed_entries" : "cast_rays";
  const std::span<const uint32_t> code = isSeed ? std::span<const uint32_t>(seed_entries_spirv) : cast_rays_spirv;
  VkShaderModuleCreateInfo moduleInfo{};
  moduleInfo.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  moduleInfo.codeSize = code.size_bytes();
  moduleInfo.pCode = code.data();
  VkShaderModule shaderModule = VK_NULL_HANDLE;
  VkResult result = vk.vkCreateShaderModule(device_.device, &moduleInfo, nullptr, &shaderModule);
  if (result != VK_SUCCESS) return device_.explain(result, "%s: vkCreateShaderModule", name);

  const Specialization values{options.checkIndices, index};
  VkSpecializationInfo specialization{};
  specialization.mapEntryCount = static_cast<uint32_t>(kSpecializationEntries.size());
  specialization.pMapEntries = kSpecializationEntries.data();
  specialization.dataSize = sizeof(values);
  specialization.pData = &values;
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = shaderModule;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &specialization;
  info.layout = layout_;
  result = vk.vkCreateComputePipelines(device_.device, cache, 1, &info, nullptr, &pipelines_[index]);
  vk.vkDestroyShaderModule(device_.device, shaderModule, nullptr);
  if (result != VK_SUCCESS) return device_.explain(result, "%s: vkCreateComputePipelines", name);
  return {};
}

}  // namespace froth
