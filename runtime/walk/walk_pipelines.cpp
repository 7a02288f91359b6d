#include "runtime/walk/walk_pipelines.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "shaders/gpu/walk_layout.h"
#include "spirv/cast_rays.h"
#include "spirv/cast_rays_several.h"
#include "spirv/mark_entries.h"
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

struct ShaderCode {
  const char* name;
  std::span<const uint32_t> spirv;
};

ShaderCode codeOf(uint32_t index) {
  if (index == kSeedEntries) return {"seed_entries", seed_entries_spirv};
  if (index == kMarkEntries) return {"mark_entries", mark_entries_spirv};
  if (index < kSeedEntries) return {"cast_rays", cast_rays_spirv};
  return {"cast_rays_several", cast_rays_several_spirv};
}

}  // namespace

Result<std::unique_ptr<WalkPipelines>> WalkPipelines::create(Device& device, VkPipelineCache cache,
                                                             const WalkOptions& options) {
  std::unique_ptr<WalkPipelines> made(new WalkPipelines(device, cache, options));
  if (const Status status = made->createLayouts(); !status) return status.error();
  if (const Status status = made->createPipelines(0, kCastSeveral); !status) return status.error();
  return made;
}

WalkPipelines::~WalkPipelines() {
  const DeviceTable& vk = device_.table;
  for (const VkPipeline pipeline : pipelines_) vk.vkDestroyPipeline(device_.device, pipeline, nullptr);
  vk.vkDestroyPipelineLayout(device_.device, layout_, nullptr);
  vk.vkDestroyDescriptorSetLayout(device_.device, setLayout_, nullptr);
}

Status WalkPipelines::prepareForSeveral() {
  return createPipelines(kCastSeveral, kWalkPipelineCount);
}

// Those that are missing.
Status WalkPipelines::createPipelines(uint32_t first, uint32_t last) {
  for (uint32_t index = first; index < last; ++index) {
    if (pipelines_[index]) continue;
    if (const Status status = createPipeline(index); !status) return status;
  }
  return {};
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

Status WalkPipelines::createPipeline(uint32_t index) {
  const DeviceTable& vk = device_.table;
  const ShaderCode shader = codeOf(index);
  VkShaderModuleCreateInfo moduleInfo{};
  moduleInfo.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  moduleInfo.codeSize = shader.spirv.size_bytes();
  moduleInfo.pCode = shader.spirv.data();
  VkShaderModule shaderModule = VK_NULL_HANDLE;
  VkResult result = vk.vkCreateShaderModule(device_.device, &moduleInfo, nullptr, &shaderModule);
  if (result != VK_SUCCESS) return device_.explain(result, "%s: vkCreateShaderModule", shader.name);

  const Specialization values{options_.checkIndices, index % kCastSeveral};
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
  result = vk.vkCreateComputePipelines(device_.device, cache_, 1, &info, nullptr, &pipelines_[index]);
  vk.vkDestroyShaderModule(device_.device, shaderModule, nullptr);
  if (result != VK_SUCCESS) return device_.explain(result, "%s: vkCreateComputePipelines", shader.name);
  return {};
}

}  // namespace froth
