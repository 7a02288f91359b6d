// Timestamps between passes, kept for each recording of the frames in flight.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "froth/froth.h"
#include "runtime/device/device.h"

namespace froth {

class PassTimer {
 public:
  static constexpr uint32_t kMaxPasses = 7;  // of a recording

  // recordings: how many can be in flight. The device has timestampBits.
  static Result<std::unique_ptr<PassTimer>> create(Device& device, uint32_t recordings);
  ~PassTimer();

  void begin(VkCommandBuffer commandBuffer, uint32_t recording);
  // The commands since begin or the last mark are the pass `name` (static storage).
  void mark(VkCommandBuffer commandBuffer, uint32_t recording, const char* name);

  // Appends the times of a recording that the GPU has completed; never waits. Stops at the capacity of
  // `status.passes`.
  void read(uint32_t recording, FrothViewStatus& status) const;

 private:
  static constexpr uint32_t kQueries = kMaxPasses + 1;

  explicit PassTimer(Device& device) : device_(device) {}
  void stamp(VkCommandBuffer commandBuffer, uint32_t query);

  Device& device_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
  std::vector<std::vector<const char*>> names_;  // [recording]; capacity kMaxPasses, so that marks allocate nothing
};

}  // namespace froth
