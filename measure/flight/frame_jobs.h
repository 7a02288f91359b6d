// Jobs of a context on a pool of threads, with a place to wait for them.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <vector>

#include "base/result.h"
#include "froth/froth_pool.h"

namespace froth {

// Jobs begin at the end of the frame that gives them, and it waits for them. So what they make is there in the next
// frame on any machine, and frothUpdate is measured without them. Destroy the context first.
class FrameJobs {
 public:
  explicit FrameJobs(uint32_t threads);
  ~FrameJobs();
  FrameJobs(const FrameJobs&) = delete;
  FrameJobs& operator=(const FrameJobs&) = delete;

  void giveTo(FrothContextInfo& info);
  void runAll();  // that were given; returns when they have ended

 private:
  struct Job {
    FrameJobs* owner;
    FrothJob run;
    void* argument;
  };

  FrothJobPool* pool_ = nullptr;
  std::vector<Job> given_;
  std::mutex mutex_;
  std::condition_variable isIdle_;
  uint32_t running_ = 0;
};

}  // namespace froth
