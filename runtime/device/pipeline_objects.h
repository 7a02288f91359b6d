// Layouts, descriptor sets and compute pipelines, as all passes make them. `name`: of the pass, for messages and
// captures.
#pragma once

#include <cstdint>
#include <memory>
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

// Sets whose bindings are alike, with their pool and layout.
class DescriptorSets {
 public:
  static Result<std::unique_ptr<DescriptorSets>> create(Device& device, const char* name, const SetBindings& bindings,
                                                        uint32_t count);
  ~DescriptorSets();

  VkDescriptorSet operator[](uint32_t index) const { return sets_[index]; }
  // Points a set [index < count] to images, one per binding. What used it before must be complete.
  VkDescriptorSet update(uint32_t index, std::span<const VkDescriptorImageInfo> images) const;

 private:
  explicit DescriptorSets(Device& device) : device_(device) {}

  Device& device_;
  SetBindings bindings_;
  VkDescriptorSetLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  std::vector<VkDescriptorSet> sets_;
};

// specialization: null if there is none.
Result<VkPipeline> createComputePipeline(Device& device, VkPipelineCache cache, const char* name,
                                         std::span<const uint32_t> spirv, const VkSpecializationInfo* specialization,
                                         VkPipelineLayout layout);

}  // namespace froth
