// Layouts and compute pipelines, as all passes make them. An error's message begins with `name`, that of the pass.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/device/device.h"

namespace froth {

// Of set 0: one descriptor per binding.
struct SetBindings {
  std::vector<VkDescriptorType> types;
  VkShaderStageFlags stages = VK_SHADER_STAGE_COMPUTE_BIT;
};

// Identical layouts are compatible, so passes and sets make their own.
Result<VkDescriptorSetLayout> createSetLayout(Device& device, const char* name, const SetBindings& bindings);

// pushBytes: of push constants for compute shaders; 0: none.
Result<VkPipelineLayout> createPipelineLayout(Device& device, const char* name, VkDescriptorSetLayout set,
                                              uint32_t pushBytes);

// specialization: null if there is none.
Result<VkPipeline> createComputePipeline(Device& device, VkPipelineCache cache, const char* name,
                                         std::span<const uint32_t> spirv, const VkSpecializationInfo* specialization,
                                         VkPipelineLayout layout);

}  // namespace froth
