// The device memory of an asset: few blocks, however many chunks there are, for devices allow few allocations.
#pragma once

#include <span>
#include <vector>

#include "runtime/device/device.h"

namespace froth {

// Gives places in the smallest gaps of blocks and takes them back one by one; a block without any is freed. One thread
// at a time.
class GpuArena {
 public:
  static constexpr VkDeviceSize kAlignment = 16;          // of the largest type that shaders load
  static constexpr VkDeviceSize kMostShared = 32u << 20;  // [bytes] of a block for more than one place
  // [bytes] `more` where places come and go: of smaller blocks more become empty
  static constexpr VkDeviceSize kMoreWherePlacesGo = 16u << 20;

  struct Place {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;      // in the buffer; a multiple of kAlignment
    VkDeviceAddress address = 0;  // of the offset
  };

  enum class Limit { kBudget, kNone };

  explicit GpuArena(Device& device, Limit limit = Limit::kBudget) : device_(device), limit_(limit) {}
  ~GpuArena();  // the GPU must be done with it
  GpuArena(const GpuArena&) = delete;
  GpuArena& operator=(const GpuArena&) = delete;

  // size > 0. `more`: how many bytes will be asked for later, about. Bytes a, a, a, ... of n places take O(log n)
  // blocks besides those of kMostShared. An error names `purpose`, or isPending(): then ask for the same again.
  Result<Place> allocate(VkDeviceSize size, VkDeviceSize more, const char* purpose);
  // size: as it was asked for. The GPU must be done with the place.
  void free(const Place& place, VkDeviceSize size);

  std::span<const GpuBuffer> blocks() const { return blocks_; }
  VkDeviceSize heldBytes() const { return heldBytes_ + orderedSize_; }  // of VkDeviceMemory

 private:
  // Of a block; not taken.
  struct Gap {
    VkDeviceSize offset, size;
  };
  using Gaps = std::vector<Gap>;  // ascending; no two touch

  VkDeviceSize chooseBlockSize(VkDeviceSize size, VkDeviceSize more) const;
  Status addBlock(VkDeviceSize size, VkDeviceSize more, const char* purpose);
  bool takeGap(VkDeviceSize size, Place& place);

  Device& device_;
  Limit limit_;
  std::vector<GpuBuffer> blocks_;
  std::vector<Gaps> gaps_;  // [blocks_]
  VkDeviceSize heldBytes_ = 0;
  VkDeviceSize orderedSize_ = 0;  // of the block that a job makes; 0: none
};

}  // namespace froth
