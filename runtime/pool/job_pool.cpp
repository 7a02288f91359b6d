#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include "froth/froth_pool.h"

namespace {

constexpr uint32_t kDefaultThreads = 2, kMostThreads = 64;

}  // namespace

struct FrothJobPool {
  struct WaitingJob {
    FrothJob job;
    void* argument;
  };

  FrothJobPool() = default;
  FrothJobPool(const FrothJobPool&) = delete;
  FrothJobPool& operator=(const FrothJobPool&) = delete;
  ~FrothJobPool() {
    {
      const std::lock_guard lock(mutex);
      isEnding = true;
    }
    changed.notify_all();
    for (std::thread& thread : threads) thread.join();
  }

  // Until the pool ends and nothing waits.
  void runJobs() {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [&] { return isEnding || !waiting.empty(); });
      if (waiting.empty()) return;
      const WaitingJob next = waiting.front();
      waiting.pop_front();
      lock.unlock();
      next.job(next.argument);
      lock.lock();
    }
  }

  std::mutex mutex;
  std::condition_variable changed;
  std::deque<WaitingJob> waiting;  // guarded by `mutex`
  bool isEnding = false;           // the same
  std::vector<std::thread> threads;
};

FrothResult frothCreateJobPool(uint32_t threads, FrothJobPool** pool) {
  if (!pool) return FROTH_ERROR_ARGUMENT;
  *pool = nullptr;
  if (threads > kMostThreads) return FROTH_ERROR_ARGUMENT;
  try {
    auto made = std::make_unique<FrothJobPool>();
    const uint32_t count = threads == 0 ? kDefaultThreads : threads;
    made->threads.reserve(count);
    for (uint32_t i = 0; i < count; ++i) made->threads.emplace_back(&FrothJobPool::runJobs, made.get());
    *pool = made.release();
    return FROTH_OK;
  } catch (const std::bad_alloc&) {
    return FROTH_ERROR_MEMORY;
  } catch (const std::system_error&) {
    return FROTH_ERROR_MEMORY;
  }
}

void frothDestroyJobPool(FrothJobPool* pool) { delete pool; }

void frothRunInPool(void* pool, FrothJob job, void* argument) {
  auto& jobs = *static_cast<FrothJobPool*>(pool);
  try {
    const std::lock_guard lock(jobs.mutex);
    jobs.waiting.push_back({job, argument});
  } catch (const std::bad_alloc&) {
    job(argument);  // late is better than never
    return;
  }
  jobs.changed.notify_one();
}
