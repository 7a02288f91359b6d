// Work that need not hold up a frame: on threads of the caller, or at once where there are none.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "froth/froth_context.h"

namespace froth {

struct JobState;

// Runs functions through the caller's FrothContextInfo::runJob. Its own calls: one thread at a time, that of the frame.
class JobRunner {
 public:
  JobRunner() = default;  // without threads: a function runs within run(), and there is room for one
  // At most `concurrency` functions are under way: from run() until forget() or drop().
  JobRunner(FrothRunJob runJob, void* user, uint32_t concurrency);

  bool hasThreads() const { return runJob_ != nullptr; }
  bool hasRoom() const { return underWay_ < concurrency_; }

  // There must be room. `work` throws nothing and keeps alive whatever it reads.
  std::shared_ptr<JobState> run(std::function<void()> work);
  static bool hasEnded(JobState& job);
  // If it has not begun it never does. One that runs ends by itself; `waits`: returns only then.
  void drop(JobState& job, bool waits);
  void forget() { --underWay_; }  // of a job that has ended and whose result was taken

 private:
  FrothRunJob runJob_ = nullptr;
  void* user_ = nullptr;
  uint32_t concurrency_ = 1, underWay_ = 0;
};

}  // namespace froth
