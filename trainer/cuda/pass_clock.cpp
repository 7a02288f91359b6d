#include "trainer/cuda/pass_clock.h"

#include <algorithm>

namespace froth {

PassClock::~PassClock() {
  for (const Mark& mark : marks_) cudaEventDestroy(mark.event);
}

void PassClock::mark(const char* pass, cudaStream_t stream) {
  cudaEvent_t event = nullptr;
  if (cudaEventCreate(&event) != cudaSuccess) return;
  cudaEventRecord(event, stream);
  marks_.push_back({pass, event});
}

std::vector<PassTime> PassClock::times(int laps) {
  std::vector<PassTime> times;
  if (marks_.empty() || cudaEventSynchronize(marks_.back().event) != cudaSuccess) return times;
  for (size_t i = 1; i < marks_.size(); ++i) {
    float milliseconds = 0;
    if (!marks_[i].pass) continue;
    if (cudaEventElapsedTime(&milliseconds, marks_[i - 1].event, marks_[i].event) != cudaSuccess) continue;
    auto found =
        std::find_if(times.begin(), times.end(), [&](const PassTime& time) { return time.name == marks_[i].pass; });
    if (found == times.end()) found = times.insert(times.end(), {marks_[i].pass, 0});
    found->milliseconds += milliseconds / static_cast<float>(laps);
  }
  return times;
}

}  // namespace froth
