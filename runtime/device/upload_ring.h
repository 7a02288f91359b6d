// Bounded staging memory through which arrays of any size reach the GPU, frame by frame.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/device/device.h"

namespace froth {

// A copy keeps its place in the ring until the frame that recorded it is complete, so that it can be recorded
// again if that frame is dropped. One thread at a time.
class UploadRing {
 public:
  static Result<std::unique_ptr<UploadRing>> create(Device& device, VkDeviceSize size);
  ~UploadRing();  // the GPU must be done with it
  UploadRing(const UploadRing&) = delete;
  UploadRing& operator=(const UploadRing&) = delete;

  // Copies as much of `bytes` into the ring as has room; returns how much that is. `owner` names who waits
  // for it.
  VkDeviceSize stage(const void* owner, VkBuffer target, VkDeviceSize targetOffset, const void* bytes,
                     VkDeviceSize size);

  // Records what is staged, oldest first, up to `limit` bytes; returns the bytes recorded.
  VkDeviceSize record(VkCommandBuffer commandBuffer, uint64_t serial, VkDeviceSize limit);

  bool isStaged(const void* owner) const;  // something of the owner waits to be recorded
  // Something of the owner waits to be recorded, or for the GPU.
  bool isUnderWay(const void* owner, uint64_t completedSerial) const;
  VkDeviceSize stagedBytes() const;                 // of all owners
  VkDeviceSize usedBytes() const { return used_; }  // staged, or recorded and not complete

  void retire(uint64_t completedSerial);  // reuses the room of completed copies
  void drop(uint64_t serial);             // that frame will not be submitted: its copies wait again
  void forget(const void* owner);         // its targets are going away

 private:
  static constexpr uint64_t kStaged = UINT64_MAX;  // in the ring, not recorded
  static constexpr uint64_t kForgotten = 0;

  struct Copy {
    const void* owner;  // null: forgotten
    VkBuffer target;
    VkBufferCopy region;
    uint64_t serial;  // of the frame that recorded it, or one of the above
  };

  void splitCopy(size_t index, VkDeviceSize size);  // into one of at most `size` bytes and the rest behind it

  explicit UploadRing(Device& device) : device_(device) {}

  Device& device_;
  GpuBuffer buffer_;
  VkDeviceSize head_ = 0;  // where the next copy goes
  VkDeviceSize used_ = 0;
  std::vector<Copy> copies_;  // in the order of their places, which follow each other without gaps
};

}  // namespace froth
