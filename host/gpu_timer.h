// GPU times of an engine's own passes, read back without waiting.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "froth/froth.h"
#include "host/frame_ring.h"

namespace froth {

class GpuTimer {
 public:
  static Result<std::unique_ptr<GpuTimer>> create(const Host& host);
  ~GpuTimer();  // the device is done with every frame

  // At most kFramesInFlight frames are under way; what a frame took is read before its slot is begun anew.
  void begin(VkCommandBuffer commands, uint64_t serial);
  // Ends a pass, which began at the mark before; `name` in static storage. At most kMostPasses in a frame.
  void mark(VkCommandBuffer commands, const char* name);

  struct Times {
    uint64_t serial = 0;  // of the frame; 0: none is complete
    std::vector<FrothPassTime> passes;
  };
  Times read(uint64_t completedSerial) const;  // of the newest complete frame

 private:
  static constexpr uint32_t kMostPasses = 15;
  struct Slot {
    VkQueryPool queries = VK_NULL_HANDLE;
    uint64_t serial = 0;
    std::vector<const char*> names;
  };

  GpuTimer(VkDevice device, double period) : device_(device), millisecondsPerTick_(period) {}

  VkDevice device_;
  double millisecondsPerTick_;
  std::array<Slot, kFramesInFlight> slots_;
  Slot* current_ = nullptr;
};

}  // namespace froth
