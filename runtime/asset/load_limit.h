// How much loading one frothUpdate begins by itself.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace froth {

// Of all assets together. What has begun is ended, so that a frame takes as much longer as its last job.
class LoadLimit {
 public:
  // With threads: the runner's room is the limit.
  static LoadLimit none() { return {}; }
  // The same on any machine.
  static LoadLimit ofWork() {
    LoadLimit limit;
    limit.workLeft_ = kWorkPerUpdate;
    return limit;
  }
  static LoadLimit ofTime(uint32_t microseconds) {
    LoadLimit limit;
    limit.end_ = Clock::now() + std::chrono::microseconds(microseconds);
    return limit;
  }

  // A job begins. work: decoded bytes of a chunk's sections; any job counts as kLeastWork at least.
  void count(uint64_t work) {
    hasBegun_ = true;
    workLeft_ -= std::min(workLeft_, std::max(work, kLeastWork));
  }
  // One job begins in any update.
  bool isReached() const { return hasBegun_ && (workLeft_ == 0 || isLate()); }
  bool isLate() const { return end_ != Clock::time_point::max() && Clock::now() >= end_; }  // never without a time

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr uint64_t kWorkPerUpdate = 4u << 20, kLeastWork = 16u << 10;  // [bytes]

  bool hasBegun_ = false;
  uint64_t workLeft_ = UINT64_MAX;
  Clock::time_point end_ = Clock::time_point::max();
};

}  // namespace froth
