// Bounded staging memory through which arrays of any size reach the GPU, frame by frame.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/device/device.h"

namespace froth {

// A copy keeps its place in the ring until the submission that it was recorded for is complete, so that it can be
// recorded again if that is dropped. Submissions have serials: those of frames, or of uploads alone. One thread at a
// time.
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

  // Nothing of the owner is still to come after the submissions up to `serial`.
  bool isWithin(const void* owner, uint64_t serial) const;
  uint64_t newestInFlight() const;                  // newest serial that was recorded and is not complete; 0: none
  VkDeviceSize stagedBytes() const;                 // of all owners; not recorded
  VkDeviceSize usedBytes() const { return used_; }  // staged, or recorded and not complete

  void retire(uint64_t completedSerial);  // reuses the room of completed copies
  void drop(uint64_t serial);             // it will not be submitted: its copies wait again
  // Its copies that are not recorded will never be. `targets` stays until the others are complete.
  void forget(const void* owner, const std::shared_ptr<void>& targets);

 private:
  static constexpr uint64_t kStaged = UINT64_MAX;  // in the ring, not recorded
  static constexpr uint64_t kForgotten = 0;

  struct Copy {
    const void* owner;  // null: forgotten
    VkBuffer target;
    VkBufferCopy region;
    uint64_t serial;                     // of the submission, or one of the above
    std::shared_ptr<void> targets = {};  // of a forgotten one that is in flight
  };

  void splitCopy(size_t index, VkDeviceSize size);  // into one of at most `size` bytes and the rest behind it

  explicit UploadRing(Device& device) : device_(device) {}

  Device& device_;
  GpuBuffer buffer_;
  VkDeviceSize head_ = 0;  // where the next copy goes
  VkDeviceSize used_ = 0;
  uint64_t completedSerial_ = 0;
  std::vector<Copy> copies_;  // in the order of their places, which follow each other without gaps
};

}  // namespace froth
