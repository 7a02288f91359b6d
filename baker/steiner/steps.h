// Long loops that stop on request.
#pragma once

#include <algorithm>
#include <cstddef>

#include <tbb/parallel_for.h>

#include "base/progress.h"

namespace froth {

// Reports the progress of one stage. Once the callback has asked to stop, nothing more is run.
class Steps {
 public:
  static constexpr size_t kPerLoop = 64;

  Steps(const Progress& progress, const char* stage, uint64_t loops)
      : progress_(progress), stage_(stage), total_(loops * kPerLoop) {}

  bool isStopped() const { return isStopped_; }

  // Calls body(i) for all i < count on all cores, in slabs with a report before each.
  template <class Body>
  void forAll(size_t count, const Body& body) {
    for (size_t slab = 0; slab < kPerLoop && advance(); ++slab) {
      tbb::parallel_for(count * slab / kPerLoop, count * (slab + 1) / kPerLoop, body);
    }
  }

  // One step of a loop that is not forAll's.
  bool advance() {
    isStopped_ = isStopped_ || !report(progress_, stage_, std::min(done_++, total_), total_);
    return !isStopped_;
  }

 private:
  const Progress& progress_;
  const char* stage_;
  uint64_t done_ = 0, total_;
  bool isStopped_ = false;
};

}  // namespace froth
