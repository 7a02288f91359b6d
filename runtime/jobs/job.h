// A function under way that gives a value or an error.
#pragma once

#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "base/result.h"
#include "runtime/jobs/job_runner.h"

namespace froth {

// Of a job that gives nothing else.
struct Done {};

inline Result<Done> doneIf(const Status& status) { return status ? Result<Done>(Done()) : status.error(); }

// Dropped where it is destroyed, without waiting. One thread at a time.
template <class T>
class Job {
 public:
  Job() = default;
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;
  ~Job() { drop(false); }

  // It must not be under way; the runner must have room and outlive it. `work` keeps alive whatever it reads.
  void start(JobRunner& runner, std::function<Result<T>()> work) {
    const auto result = std::make_shared<std::optional<Result<T>>>();
    result_ = result;
    runner_ = &runner;
    state_ = runner.run([result, work = std::move(work)] {
      try {
        *result = work();
      } catch (const std::bad_alloc&) {
        *result = Result<T>(Error{ErrorKind::kMemory, "host memory is exhausted"});
      }
    });
  }

  bool isUnderWay() const { return state_ != nullptr; }  // started, and its result was not taken
  bool hasEnded() const { return state_ && JobRunner::hasEnded(*state_); }

  // It must have ended.
  Result<T> take() {
    runner_->forget();
    state_.reset();
    Result<T> result = std::move(**result_);
    result_.reset();
    return result;
  }

  // waits: what `work` reads may go away afterwards.
  void drop(bool waits) {
    if (state_) runner_->drop(*state_, waits);
    state_.reset();
    result_.reset();
  }

 private:
  JobRunner* runner_ = nullptr;
  std::shared_ptr<JobState> state_;
  std::shared_ptr<std::optional<Result<T>>> result_;
};

}  // namespace froth
