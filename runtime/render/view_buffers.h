// The transient buffers that one view has for an instance. They grow and shrink in prepare() only; what is replaced is
// kept until no frame uses it.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "froth/froth.h"
#include "runtime/device/device.h"
#include "runtime/render/view_capacity.h"

namespace froth {

// What each holds is said in shaders/gpu/layout.h, at FrameBlock. Those of a group grow together, and share an
// allocation: each costs drivers time, and devices allow few. A group with nothing to hold has none.
enum class ViewBuffer : uint32_t {
  // of the extent and the asset
  kFrames,  // blocks and chunk tables of the recordings of a frame, on the device
  kCounters,
  kGroupSums,
  kVisibility,
  kTileLists,
  kWalkStart,
  // of pixels
  kRays,  // these two are empty where no lens is mapped
  kCones,
  kHits,  // empty where the view does not keep them, as is
  kQuarters,
  kFade,
  // of cells, pairs and tiles
  kTallies,  // TallyLayout
  // of visible cells
  kVisibleCells,
  kCellKeys,
  kCellKeysSwap,
  kOrder,
  kOrderSwap,
  kSlotTiles,
  kTileCounts,
  kRecords,
  kDetails,
  // of their planes
  kPlanes,
  // of pairs
  kPairTiles,
  kPairTilesSwap,
  kPairCells,
  kPairCellsSwap,
  // on the host; apart, for frames in flight are read back while the asset changes
  kStaging,   // as kFrames, for all frames in flight, written by the CPU
  kReadback,  // Counters of all frames in flight
};
inline constexpr uint32_t kViewBufferCount = 28;

// [bytes] The space of a FrameBlock with its HitBlock, and of Counters. The chunk table follows its block.
inline constexpr VkDeviceSize kBlockStride = 2048;

class ViewBuffers {
 public:
  explicit ViewBuffers(Device& device) : device_(device) {}
  ~ViewBuffers();  // the GPU must be done with them

  // Makes every buffer large enough; replaces the groups that are not. `lastSerial`: the newest frame that may use what
  // is replaced; 0: none. On failure, and while memory is ordered, the old buffers and the old capacity stay.
  Status grow(const ViewCapacity& wanted, uint64_t lastSerial);
  void freeRetired(uint64_t completedSerial);

  // For a lowered budget. The next recordings use no more than `lessened`; trim() then replaces the groups that are
  // larger, one by one: the next when the one before is freed, so that little more is held meanwhile.
  void lessen(const ViewCapacity& lessened) { capacity_ = lessened; }
  Status trim(uint64_t lastSerial, uint64_t completedSerial);
  bool isTrimmed() const;  // no buffer is larger than the capacity, or waits to be freed

  const GpuBuffer& operator[](ViewBuffer id) const { return buffers_[static_cast<uint32_t>(id)]; }
  bool areMade() const { return buffers_[0].size != 0; }  // not before the first grow() that succeeds
  const ViewCapacity& capacity() const { return capacity_; }
  // Cells that the next recordings will probably show; any number is right, and one near it is fast.
  void expectCells(uint64_t cells) { expectedCells_ = cells; }
  uint32_t sortRounds() const;  // FrameBlock::sortRounds
  TallyLayout tallies() const { return layOutTallies(capacity_, sortRounds()); }
  VkDeviceSize deviceBytes() const;
  void addMemory(FrothViewStatus& status) const;
  VkDeviceSize recordingStride() const;  // [bytes] from one recording's block to the next, in kFrames and kStaging

 private:
  using Buffers = std::array<GpuBuffer, kViewBufferCount>;
  void replaceBy(const Buffers& made, uint64_t lastSerial);

  Device& device_;
  ViewCapacity capacity_;
  uint64_t expectedCells_ = 0;
  Buffers buffers_{};
  std::vector<std::pair<uint64_t, GpuBuffer>> retired_;
};

// [bytes] Device memory, and host memory, of buffers that are as large as the capacity.
VkDeviceSize bytesOf(const ViewCapacity& capacity);
VkDeviceSize hostBytesOf(const ViewCapacity& capacity);

}  // namespace froth
