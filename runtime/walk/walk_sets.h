// What rays in an engine's shaders read of the world, and the rays that the runtime casts itself (froth/froth_walk.h).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "froth/froth_walk.h"
#include "runtime/asset/gpu_asset.h"
#include "runtime/device/device.h"
#include "runtime/render/view_renderer.h"
#include "runtime/walk/walk_pipelines.h"

namespace froth {

// One instance, drawable: its asset has a walk graph and live cells.
struct WalkedInstance {
  RenderInstance placement;
  uint32_t mask;
  bool isSeeded;                       // the asset's entries are there, or on their way in an earlier command
  std::span<const uint32_t> toFill{};  // slots of chunks whose cells are to be prepared; of one instance of an asset
};

// One thread at a time.
class WalkSets {
 public:
  static Result<std::unique_ptr<WalkSets>> create(Device& device, VkPipelineCache cache, const WalkOptions& options,
                                                  uint32_t framesInFlight);
  ~WalkSets();  // the GPU must be done with them

  VkDescriptorSetLayout layout() const { return pipelines_->setLayout(); }

  // In frothUpdate: reads counters of complete frames, frees what was replaced, grows tables to so many chunks of all
  // instances together: those of an instance that is not seeded count twice. On an error they are as before.
  Status prepare(uint64_t completedSerial, uint32_t chunkCount);
  // Makes what casts rays through several instances; until then rays meet the first. Any thread.
  Status prepareMerging() { return pipelines_->prepareMerging(); }
  bool canMerge() const { return pipelines_->canMerge(); }
  // Makes what casts rays through cells of which so much is prepared (kPreparedNothing...); until then they are
  // decoded. Any thread.
  Status prepareFor(uint32_t prepared) { return pipelines_->prepareFor(prepared); }
  uint32_t mostPrepared() const { return pipelines_->mostPrepared(); }
  bool hasSpaceFor(uint32_t chunkCount) const { return chunkCount <= chunkCapacity_; }

  // info: defaults resolved. Instances: at most FROTH_WALK_MOST_INSTANCES, with space for all their chunks. Once per
  // frame.
  VkDescriptorSet record(VkCommandBuffer commandBuffer, const FrothWalkInfo& info,
                         std::span<const WalkedInstance> instances, uint64_t serial);
  bool isRecorded(uint64_t serial) const { return recordedSerial_ == serial; }
  // After record() in the same frame.
  void recordRays(VkCommandBuffer commandBuffer, VkDeviceAddress rays, VkDeviceAddress hits, uint32_t count,
                  FrothRayKind kind) const;

  void dropFrame(uint64_t serial);
  const FrothWalkStatus& status() const { return status_; }

 private:
  struct Slot {
    VkDescriptorSet set = VK_NULL_HANDLE;
    uint64_t serial = 0;  // of the frame that uses it; 0: none
  };

  WalkSets(Device& device, bool countsWork, uint32_t framesInFlight);
  Status grow(uint32_t chunkCount);
  void readCounters(const Slot& slot);
  VkDeviceSize stride() const;
  void writeTables(uint32_t slot, const FrothWalkInfo& info, std::span<const WalkedInstance> instances);
  void updateSet(uint32_t slot);
  void prepareCells(VkCommandBuffer commandBuffer, std::span<const WalkedInstance> instances,
                    VkPipelineStageFlags2 stages) const;
  void seedEntries(VkCommandBuffer commandBuffer, std::span<const WalkedInstance> instances,
                   VkPipelineStageFlags2 stages) const;
  void recordSeeds(VkCommandBuffer commandBuffer, uint32_t pipeline, uint32_t instance, const GpuAsset& asset) const;
  void pushSeed(VkCommandBuffer commandBuffer, const SeedConstants& constants) const;
  void bind(VkCommandBuffer commandBuffer, uint32_t pipeline) const;
  void recordCopies(VkCommandBuffer commandBuffer, uint32_t slot, VkPipelineStageFlags2 stages) const;

  Device& device_;
  bool countsWork_;
  std::unique_ptr<WalkPipelines> pipelines_;
  std::unique_ptr<DescriptorSets> sets_;
  std::vector<Slot> slots_;  // [frames in flight]
  GpuBuffer tables_, staging_, counters_;
  uint32_t chunkCapacity_ = 0;
  uint32_t current_ = 0;                       // slot of the newest recording
  uint32_t instanceCount_ = 0;                 // in it
  uint32_t prepared_ = gpu::kPreparedNothing;  // what casting takes as prepared of all of them
  uint64_t recordedSerial_ = 0;
  std::vector<std::pair<uint64_t, GpuBuffer>> retired_;  // newest serial that may use it
  FrothWalkStatus status_{};
};

}  // namespace froth
