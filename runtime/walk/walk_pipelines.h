// Layouts and pipelines of walk sets. Made at context creation, never inside a record call.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>

#include "runtime/device/pipeline_objects.h"

namespace froth {

struct WalkOptions {
  bool checkIndices = false, countsWork = false;
};

// Those that cast rays of a FrothRayKind through one instance at a time begin at 0, through several at once at
// kCastMerged.
inline constexpr uint32_t kSeedEntries = 3, kMarkEntries = 4, kPrepareCells = 5, kCastMerged = 6,
                          kWalkPipelineCount = 9;

struct CastConstants {
  VkDeviceAddress rays, hits;
  uint32_t count, padding;
};

struct SeedConstants {
  uint32_t instance;
};

class WalkPipelines {
 public:
  static Result<std::unique_ptr<WalkPipelines>> create(Device& device, VkPipelineCache cache,
                                                       const WalkOptions& options);
  ~WalkPipelines();

  // Makes those from kCastMerged on; if they are there already, returns at once. Any thread.
  Status prepareMerging();
  bool canMerge() const { return canMerge_; }

  static SetBindings bindings();
  VkDescriptorSetLayout setLayout() const { return setLayout_; }
  VkPipelineLayout layout() const { return layout_; }
  VkPipeline operator[](uint32_t pipeline) const { return pipelines_[pipeline]; }

 private:
  WalkPipelines(Device& device, VkPipelineCache cache, const WalkOptions& options)
      : device_(device), cache_(cache), options_(options) {}
  Status createLayouts();
  Status createPipelines(uint32_t first, uint32_t last);
  Status createPipeline(uint32_t index);

  Device& device_;
  VkPipelineCache cache_;
  WalkOptions options_;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  std::array<VkPipeline, kWalkPipelineCount> pipelines_{};
  std::atomic<bool> canMerge_ = false;
  std::mutex making_;
};

}  // namespace froth
