// The transient buffers of one view. They grow in prepare() only; what they replace is kept until no frame
// uses it.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "runtime/asset/gpu_asset.h"
#include "runtime/core/device.h"

namespace froth {

// What each holds is said in shaders/gpu/layout.h, at FrameBlock.
enum class ViewBuffer : uint32_t {
  kFrames,    // blocks and chunk tables of the recordings of a frame, on the device
  kStaging,   // the same for all frames in flight, written by the CPU
  kReadback,  // Counters of all frames in flight
  kCounters,
  kGroupSums,
  kVisibilityMasks,
  kSlotOfCell,
  kVisibleCells,
  kCellKeys,
  kCellKeysSwap,
  kOrder,
  kOrderSwap,
  kRecords,
  kPlanes,
  kSites,
  kTileCounts,
  kPairTiles,
  kPairTilesSwap,
  kPairCells,
  kPairCellsSwap,
  kTileRanges,
  kHistogram,
  kWalkStart,
};
inline constexpr uint32_t kViewBufferCount = 23;
inline constexpr uint32_t kRecordingsPerFrame = 2;  // a raster and a walk

// [bytes] The space of a FrameBlock and of Counters. The chunk table follows its block.
inline constexpr VkDeviceSize kBlockStride = 512;

// What a view has space for. Only ever grows.
struct ViewCapacity {
  uint32_t frames = 1;  // in flight
  uint32_t chunks = 1;
  uint32_t groups = 1;  // chunks times workgroups over the largest chunk's live cells
  uint32_t cells = 1;   // live
  uint32_t pairs = 1;
  uint32_t tiles = 1;
  uint64_t planes = 1;
  uint64_t sites = 1;  // live cells times K
};

// Workgroups over the live cells of an asset's largest chunk.
uint32_t groupsPerChunk(const GpuAsset& asset);

// Adds what an asset needs.
void coverAsset(const GpuAsset& asset, ViewCapacity& capacity);
bool coversAsset(const GpuAsset& asset, const ViewCapacity& capacity);

class ViewBuffers {
 public:
  explicit ViewBuffers(Device& device) : device_(device) {}
  ~ViewBuffers();  // the GPU must be done with them

  // Makes every buffer large enough. `lastSerial`: the newest frame that may use what is replaced. On failure
  // the old buffers and the old capacity stay.
  Status grow(const ViewCapacity& wanted, uint64_t lastSerial);
  void freeRetired(uint64_t completedSerial);

  const GpuBuffer& operator[](ViewBuffer id) const { return buffers_[static_cast<uint32_t>(id)]; }
  const ViewCapacity& capacity() const { return capacity_; }
  VkDeviceSize deviceBytes() const;
  VkDeviceSize recordingStride()
      const;  // [bytes] from one recording's block to the next, in kFrames and kStaging

 private:
  Device& device_;
  ViewCapacity capacity_;
  std::array<GpuBuffer, kViewBufferCount> buffers_{};
  std::vector<std::pair<uint64_t, GpuBuffer>> retired_;
};

}  // namespace froth
