#include "runtime/jobs/job_runner.h"

#include <condition_variable>
#include <mutex>
#include <utility>

namespace froth {

enum class JobPhase { kWaiting, kRunning, kEnded };

struct JobState {
  std::mutex mutex;
  std::condition_variable ended;
  JobPhase phase = JobPhase::kWaiting;  // guarded by `mutex`
  std::function<void()> work;           // of the thread that runs it, then empty
};

namespace {

void runState(JobState& job) {
  {
    const std::lock_guard lock(job.mutex);
    if (job.phase != JobPhase::kWaiting) return;  // dropped
    job.phase = JobPhase::kRunning;
  }
  job.work();
  job.work = nullptr;  // with what it holds, before others learn that it has ended
  const std::lock_guard lock(job.mutex);
  job.phase = JobPhase::kEnded;
  job.ended.notify_all();
}

// A FrothJob; owns its argument.
void runArgument(void* argument) {
  const std::unique_ptr<std::shared_ptr<JobState>> job(static_cast<std::shared_ptr<JobState>*>(argument));
  runState(**job);
}

}  // namespace

JobRunner::JobRunner(FrothRunJob runJob, void* user, uint32_t concurrency)
    : runJob_(runJob), user_(user), concurrency_(concurrency) {}

std::shared_ptr<JobState> JobRunner::run(std::function<void()> work) {
  auto job = std::make_shared<JobState>();
  job->work = std::move(work);
  if (runJob_) {
    auto argument = std::make_unique<std::shared_ptr<JobState>>(job);
    runJob_(user_, &runArgument, argument.release());
  } else {
    runState(*job);
  }
  ++underWay_;
  return job;
}

bool JobRunner::hasEnded(JobState& job) {
  const std::lock_guard lock(job.mutex);
  return job.phase == JobPhase::kEnded;
}

void JobRunner::drop(JobState& job, bool waits) {
  --underWay_;
  std::unique_lock lock(job.mutex);
  if (job.phase == JobPhase::kWaiting) {
    job.phase = JobPhase::kEnded;
    std::function<void()>().swap(job.work);
  } else if (waits) {
    job.ended.wait(lock, [&] { return job.phase == JobPhase::kEnded; });
  }
}

}  // namespace froth
