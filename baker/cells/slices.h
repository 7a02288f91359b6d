// Parallel loops that report between their parts, so that a stop request never waits long. Internal to the baker.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string_view>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "base/progress.h"

namespace froth {

// Where a loop lies in its stage.
struct StageProgress {
  const Progress& progress;
  std::string_view stage;
  uint64_t done = 0, total = 0;  // items of the stage before the loop, and in all
};

// Calls work(slice) for slices [0, count) on all cores, in waves of about a tenth of a second; `sliceItems` is the
// items of a slice as reported. False: asked to stop.
template <class Work>
bool forEachSlice(uint32_t count, uint32_t sliceItems, const StageProgress& stage, Work&& work) {
  using Clock = std::chrono::steady_clock;
  constexpr double kWaveSeconds = 0.1;
  uint32_t wave = static_cast<uint32_t>(tbb::this_task_arena::max_concurrency());
  for (uint32_t first = 0; first < count;) {
    if (!report(stage.progress, stage.stage, stage.done + uint64_t{first} * sliceItems, stage.total)) return false;
    const uint32_t last = first + std::min(wave, count - first);
    const Clock::time_point begin = Clock::now();
    tbb::parallel_for(tbb::blocked_range<uint32_t>(first, last, 1), [&](const tbb::blocked_range<uint32_t>& range) {
      for (uint32_t slice = range.begin(); slice < range.end(); ++slice) work(slice);
    });
    if (std::chrono::duration<double>(Clock::now() - begin).count() < kWaveSeconds / 2) wave *= 2;
    first = last;
  }
  return true;
}

}  // namespace froth
