// Frames in flight: while the GPU draws one frame, the CPU records the next.
#pragma once

#include <array>
#include <memory>

#include "host/host.h"

namespace froth {

constexpr uint32_t kFramesInFlight = 2;  // Froth is told the same number

struct FrameSlot {
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  VkSemaphore isAcquired = VK_NULL_HANDLE;  // the swapchain's image may be written
  VkFence isComplete = VK_NULL_HANDLE;
  uint64_t serial = 0;  // of the submission that the fence stands for; 0: none yet
};

class FrameRing {
 public:
  static Result<std::unique_ptr<FrameRing>> create(const Host& host);
  ~FrameRing();  // the device is done with every frame

  // Waits until the slot of the next frame is free: its last submission is complete.
  Result<FrameSlot*> wait();
  // Begins the slot's command buffer.
  Status begin(FrameSlot& slot);
  // Ends and submits it. It waits for the acquired image at the blit that first writes it, and signals
  // `isDrawn`.
  Status submit(FrameSlot& slot, VkSemaphore isDrawn);

  // Serials are what Froth measures time in: one number per submission, growing.
  uint64_t nextSerial() const { return submitted_ + 1; }
  uint64_t completedSerial() const { return completed_; }

 private:
  explicit FrameRing(const Host& host) : host_(host) {}
  Status createSlot(FrameSlot& slot);

  const Host& host_;
  std::array<FrameSlot, kFramesInFlight> slots_;
  uint64_t submitted_ = 0, completed_ = 0;
};

}  // namespace froth
