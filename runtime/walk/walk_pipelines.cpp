#include "runtime/walk/walk_pipelines.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "shaders/gpu/walk_layout.h"
#include "spirv/cast_rays.h"
#include "spirv/cast_rays_merged.h"
#include "spirv/mark_entries.h"
#include "spirv/prepare_cells.h"
#include "spirv/seed_entries.h"

namespace froth {
namespace {

constexpr uint32_t kWalkConstantBytes = std::max(sizeof(CastConstants), sizeof(SeedConstants));

// constant_id 0, 1 of cast_rays.comp.
struct CastSpecialization {
  VkBool32 checkIndices;
  uint32_t kind;
};

constexpr std::array<VkSpecializationMapEntry, 2> kCastSpecialization = {{
    {0, offsetof(CastSpecialization, checkIndices), sizeof(VkBool32)},
    {1, offsetof(CastSpecialization, kind), sizeof(uint32_t)},
}};

struct ShaderCode {
  const char* name;
  std::span<const uint32_t> spirv;
};

ShaderCode codeOf(uint32_t index) {
  if (index == kSeedEntries) return {"seed_entries", seed_entries_spirv};
  if (index == kMarkEntries) return {"mark_entries", mark_entries_spirv};
  if (index == kPrepareCells) return {"prepare_cells", prepare_cells_spirv};
  if (index < kSeedEntries) return {"cast_rays", cast_rays_spirv};
  return {"cast_rays_merged", cast_rays_merged_spirv};
}

}  // namespace

Result<std::unique_ptr<WalkPipelines>> WalkPipelines::create(Device& device, VkPipelineCache cache,
                                                             const WalkOptions& options) {
  std::unique_ptr<WalkPipelines> made(new WalkPipelines(device, cache, options));
  if (const Status status = made->createLayouts(); !status) return status.error();
  if (const Status status = made->createPipelines(0, kCastMerged); !status) return status.error();
  return made;
}

WalkPipelines::~WalkPipelines() {
  const DeviceTable& vk = device_.table;
  for (const VkPipeline pipeline : pipelines_) vk.vkDestroyPipeline(device_.device, pipeline, nullptr);
  vk.vkDestroyPipelineLayout(device_.device, layout_, nullptr);
  vk.vkDestroyDescriptorSetLayout(device_.device, setLayout_, nullptr);
}

Status WalkPipelines::prepareMerging() {
  const std::lock_guard making(making_);
  const Status status = createPipelines(kCastMerged, kWalkPipelineCount);
  if (status) canMerge_ = true;
  return status;
}

// Those that are missing.
Status WalkPipelines::createPipelines(uint32_t first, uint32_t last) {
  for (uint32_t index = first; index < last; ++index) {
    if (pipelines_[index]) continue;
    if (const Status status = createPipeline(index); !status) return status;
  }
  return {};
}

SetBindings WalkPipelines::bindings() {
  static_assert(gpu::kBindingWalk == 0 && gpu::kBindingWalkCounters == 1);
  return {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, VK_SHADER_STAGE_ALL};
}

Status WalkPipelines::createLayouts() {
  constexpr const char* kName = "walk sets";
  const Result<VkDescriptorSetLayout> setLayout = createSetLayout(device_, kName, bindings());
  if (!setLayout) return setLayout.error();
  setLayout_ = *setLayout;
  const Result<VkPipelineLayout> layout = createPipelineLayout(device_, kName, setLayout_, kWalkConstantBytes);
  if (!layout) return layout.error();
  layout_ = *layout;
  return {};
}

Status WalkPipelines::createPipeline(uint32_t index) {
  const CastSpecialization values{options_.checkIndices, index % kCastMerged};
  VkSpecializationInfo specialization{};
  specialization.mapEntryCount = static_cast<uint32_t>(kCastSpecialization.size());
  specialization.pMapEntries = kCastSpecialization.data();
  specialization.dataSize = sizeof(values);
  specialization.pData = &values;
  const ShaderCode shader = codeOf(index);
  const Result<VkPipeline> pipeline =
      createComputePipeline(device_, cache_, shader.name, shader.spirv, &specialization, layout_);
  if (!pipeline) return pipeline.error();
  pipelines_[index] = *pipeline;
  return {};
}

}  // namespace froth
