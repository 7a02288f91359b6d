// Layouts and pipelines of walk sets. Made at context creation, never inside a record call.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <span>

#include "runtime/device/pipeline_objects.h"
#include "shaders/gpu/layout.h"

namespace froth {

struct WalkOptions {
  bool checkIndices = false, countsWork = false;
};

inline constexpr uint32_t kSeedEntries = 0, kMarkEntries = 1, kPrepareCells = 2, kFirstCast = 3;
inline constexpr uint32_t kRayKinds = 3, kPreparedForms = gpu::kPreparedRadiance + 1;
inline constexpr uint32_t kWalkPipelineCount = kFirstCast + 2 * kPreparedForms * kRayKinds;

// What casts rays of a FrothRayKind, with so much of cells prepared (kPreparedNothing...): through the first instance,
// or merged, through several.
struct CastForm {
  uint32_t kind, prepared;
  bool isMerged;
};

uint32_t castPipeline(const CastForm& form);

struct CastConstants {
  VkDeviceAddress rays, hits;
  uint32_t count, padding;
};

struct SeedConstants {
  uint32_t instance;
  uint32_t slot;  // of prepare_cells.comp
};

class WalkPipelines {
 public:
  static Result<std::unique_ptr<WalkPipelines>> create(Device& device, VkPipelineCache cache,
                                                       const WalkOptions& options);
  ~WalkPipelines();

  // Makes the merged ones, or those for so much prepared; if they are there already, returns at once. Any thread.
  Status prepareMerging();
  Status prepareFor(uint32_t prepared);
  bool canMerge() const { return canMerge_; }
  uint32_t mostPrepared() const { return mostPrepared_; }

  static SetBindings bindings();
  VkDescriptorSetLayout setLayout() const { return setLayout_; }
  VkPipelineLayout layout() const { return layout_; }
  VkPipeline operator[](uint32_t pipeline) const { return pipelines_[pipeline]; }

 private:
  WalkPipelines(Device& device, VkPipelineCache cache, const WalkOptions& options)
      : device_(device), cache_(cache), options_(options) {}
  Status createLayouts();
  Status createCasts(bool isMerged, uint32_t prepared);
  Status createPipeline(uint32_t index, const char* name, std::span<const uint32_t> spirv, const CastForm& form);

  Device& device_;
  VkPipelineCache cache_;
  WalkOptions options_;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  std::array<VkPipeline, kWalkPipelineCount> pipelines_{};
  // What both allow is there.
  std::atomic<bool> canMerge_ = false;
  std::atomic<uint32_t> mostPrepared_ = gpu::kPreparedNothing;
  std::mutex making_;
};

}  // namespace froth
