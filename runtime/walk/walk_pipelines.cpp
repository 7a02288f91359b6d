#include "runtime/walk/walk_pipelines.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "froth/froth_walk.h"
#include "shaders/gpu/walk_layout.h"
#include "spirv/cast_rays.h"
#include "spirv/cast_rays_merged.h"
#include "spirv/mark_entries.h"
#include "spirv/prepare_cells.h"
#include "spirv/seed_entries.h"

namespace froth {
namespace {

constexpr uint32_t kWalkConstantBytes = std::max(sizeof(CastConstants), sizeof(SeedConstants));

// constant_id 0... of cast_rays.comp.
struct CastSpecialization {
  VkBool32 checkIndices;
  uint32_t kind, prepared;
  VkBool32 countsWork;
};

constexpr std::array<VkSpecializationMapEntry, 4> kCastSpecialization = {{
    {0, offsetof(CastSpecialization, checkIndices), sizeof(VkBool32)},
    {1, offsetof(CastSpecialization, kind), sizeof(uint32_t)},
    {2, offsetof(CastSpecialization, prepared), sizeof(uint32_t)},
    {3, offsetof(CastSpecialization, countsWork), sizeof(VkBool32)},
}};

}  // namespace

// Only colours need the detail sites of kPreparedRadiance.
uint32_t castPipeline(const CastForm& form) {
  const bool isSeen = form.kind == FROTH_RAY_RADIANCE;
  const uint32_t prepared = isSeen ? form.prepared : std::min(form.prepared, gpu::kPreparedVisibility);
  return kFirstCast + ((form.isMerged ? kPreparedForms : 0) + prepared) * kRayKinds + form.kind;
}

Result<std::unique_ptr<WalkPipelines>> WalkPipelines::create(Device& device, VkPipelineCache cache,
                                                             const WalkOptions& options) {
  std::unique_ptr<WalkPipelines> made(new WalkPipelines(device, cache, options));
  if (const Status status = made->createLayouts(); !status) return status.error();
  const auto make = [&](uint32_t index, const char* name, std::span<const uint32_t> spirv) {
    return made->createPipeline(index, name, spirv, {});
  };
  if (const Status status = make(kSeedEntries, "seed_entries", seed_entries_spirv); !status) return status.error();
  if (const Status status = make(kMarkEntries, "mark_entries", mark_entries_spirv); !status) return status.error();
  if (const Status status = make(kPrepareCells, "prepare_cells", prepare_cells_spirv); !status) return status.error();
  if (const Status status = made->createCasts(false, gpu::kPreparedNothing); !status) return status.error();
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
  const Status status = createCasts(true, mostPrepared_);
  if (status) canMerge_ = true;
  return status;
}

Status WalkPipelines::prepareFor(uint32_t prepared) {
  const std::lock_guard making(making_);
  if (prepared <= mostPrepared_) return {};
  if (const Status status = createCasts(false, prepared); !status) return status;
  if (canMerge_) {
    if (const Status status = createCasts(true, prepared); !status) return status;
  }
  mostPrepared_ = prepared;
  return {};
}

Status WalkPipelines::createCasts(bool isMerged, uint32_t prepared) {
  const char* name = isMerged ? "cast_rays_merged" : "cast_rays";
  const std::span<const uint32_t> spirv =
      isMerged ? std::span<const uint32_t>(cast_rays_merged_spirv) : std::span<const uint32_t>(cast_rays_spirv);
  for (CastForm form{0, gpu::kPreparedNothing, isMerged}; form.prepared <= prepared; ++form.prepared) {
    for (form.kind = 0; form.kind < kRayKinds; ++form.kind) {
      if (const Status status = createPipeline(castPipeline(form), name, spirv, form); !status) return status;
    }
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

// If it is missing.
Status WalkPipelines::createPipeline(uint32_t index, const char* name, std::span<const uint32_t> spirv,
                                     const CastForm& form) {
  if (pipelines_[index]) return {};
  const CastSpecialization values{options_.checkIndices, form.kind, form.prepared, options_.countsWork};
  VkSpecializationInfo specialization{};
  specialization.mapEntryCount = static_cast<uint32_t>(kCastSpecialization.size());
  specialization.pMapEntries = kCastSpecialization.data();
  specialization.dataSize = sizeof(values);
  specialization.pData = &values;
  const Result<VkPipeline> pipeline = createComputePipeline(device_, cache_, name, spirv, &specialization, layout_);
  if (!pipeline) return pipeline.error();
  pipelines_[index] = *pipeline;
  return {};
}

}  // namespace froth
