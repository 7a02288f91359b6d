// Layouts and pipelines of walk sets. Made at context creation, never inside a record call.
#pragma once

#include <array>
#include <memory>

#include "runtime/core/device.h"

namespace froth {

struct WalkOptions {
  bool checkIndices = false, countsWork = false;
};

// By FrothRayKind, then that which seeds the entries of an asset.
inline constexpr uint32_t kWalkPipelineCount = 4, kSeedPipeline = 3;

struct CastConstants {
  VkDeviceAddress rays, hits;
  uint32_t count, padding;
};

struct SeedConstants {
  uint32_t instance;
};

class WalkPipelines {
 public:
  static Result<std::unique_ptr<WalkPipelines>> create(Device& device, VkPipelineCache cache, const WalkOptions& options);
  ~WalkPipelines();

  VkDescriptorSetLayout setLayout() const { return setLayout_; }
  VkPipelineLayout layout() const { return layout_; }
  VkPipeline operator[](uint32_t pipeline) const { return pipelines_[pipeline]; }

 private:
  explicit WalkPipelines(Device& device) : device_(device) {}
  Status createLayouts();
  Status createPipeline(uint32_t index, VkPipelineCache cache, const WalkOptions& options);

  Device& device_;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  std::array<VkPipeline, kWalkPipelineCount> pipelines_{};
};

}  // namespace froth
