#include "measure/flight/frame_jobs.h"

namespace froth {

// Without a pool, for lack of threads, jobs run at once.
FrameJobs::FrameJobs(uint32_t threads) { frothCreateJobPool(threads, &pool_); }

// Jobs of a context that is gone do nothing but free what they hold.
FrameJobs::~FrameJobs() {
  runAll();
  frothDestroyJobPool(pool_);
}

void FrameJobs::giveTo(FrothContextInfo& info) {
  info.jobUser = this;
  info.runJob = [](void* user, FrothJob job, void* argument) {
    auto* const jobs = static_cast<FrameJobs*>(user);
    jobs->given_.push_back({jobs, job, argument});
  };
}

void FrameJobs::runAll() {
  running_ = static_cast<uint32_t>(given_.size());
  for (Job& job : given_) {
    const auto run = [](void* given) {
      const Job& mine = *static_cast<Job*>(given);
      mine.run(mine.argument);
      const std::lock_guard<std::mutex> lock(mine.owner->mutex_);
      if (--mine.owner->running_ == 0) mine.owner->isIdle_.notify_all();
    };
    if (pool_) {
      frothRunInPool(pool_, run, &job);
    } else {
      run(&job);
    }
  }
  std::unique_lock<std::mutex> lock(mutex_);
  isIdle_.wait(lock, [this] { return running_ == 0; });
  given_.clear();
}

}  // namespace froth
