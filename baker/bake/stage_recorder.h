// Closes the stages of a bake, one after the other, with what each took. Internal to baker/bake.
#pragma once

#include <sys/resource.h>

#include <chrono>
#include <cstdint>
#include <vector>

#include "baker/bake/bake.h"

namespace froth {

class StageRecorder {
 public:
  explicit StageRecorder(std::vector<StageReport>& stages) : stages_(stages) {}

  void finish(const char* stage, uint64_t items) {
    const Clock::time_point now = Clock::now();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    stages_.push_back({stage, std::chrono::duration<double>(now - begin_).count(), items,
                       static_cast<uint64_t>(usage.ru_maxrss) * 1024});
    begin_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::vector<StageReport>& stages_;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace froth
