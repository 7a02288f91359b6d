#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "froth/froth_files.h"

namespace {

struct Read {
  uint64_t offset, size;  // [bytes] in the file
  void* destination;
};

FrothResult readFrom(int descriptor, const Read& read) {
  constexpr uint64_t kMostAtOnce = uint64_t{1} << 30;  // Linux reads at most 2 GiB by one call
  for (uint64_t done = 0; done < read.size;) {
    const uint64_t wanted = std::min(read.size - done, kMostAtOnce);
    const ssize_t got = ::pread(descriptor, static_cast<char*>(read.destination) + done, wanted,
                                static_cast<off_t>(read.offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return FROTH_ERROR_FILE;  // 0: the file became shorter
    done += static_cast<uint64_t>(got);
  }
  return FROTH_OK;
}

// What the jobs of a file share; it lives as long as the last of them.
class Reads {
 public:
  Reads(FrothContext* context, int descriptor) : context_(context), descriptor_(descriptor) {}
  Reads(const Reads&) = delete;
  Reads& operator=(const Reads&) = delete;
  ~Reads() { ::close(descriptor_); }

  void add(uint64_t request, const Read& read) {
    const std::lock_guard lock(mutex_);
    waiting_.emplace(request, read);
  }

  // Unless it was cancelled.
  void run(uint64_t request) {
    std::unique_lock lock(mutex_);
    const auto found = waiting_.find(request);
    if (found == waiting_.end()) return;
    const Read read = found->second;
    waiting_.erase(found);
    ++running_;
    lock.unlock();
    frothCompleteRead(context_, request, readFrom(descriptor_, read));
    lock.lock();
    if (--running_ == 0) isIdle_.notify_all();
  }

  // One that runs ends by itself.
  void cancel(uint64_t request) {
    if (forget(request)) frothCompleteRead(context_, request, FROTH_ERROR_STATE);
  }

  // One that could not be given to a thread.
  void refuse(uint64_t request) {
    forget(request);
    frothCompleteRead(context_, request, FROTH_ERROR_MEMORY);
  }

  void finish() {
    std::unique_lock lock(mutex_);
    while (!waiting_.empty()) {
      const uint64_t request = waiting_.begin()->first;
      lock.unlock();
      cancel(request);
      lock.lock();
    }
    isIdle_.wait(lock, [this] { return running_ == 0; });
  }

 private:
  // False: it is not waiting.
  bool forget(uint64_t request) {
    const std::lock_guard lock(mutex_);
    return waiting_.erase(request) > 0;
  }

  FrothContext* context_;
  int descriptor_;
  std::mutex mutex_;
  std::condition_variable isIdle_;
  std::map<uint64_t, Read> waiting_;  // by request; guarded by `mutex_`
  uint32_t running_ = 0;              // the same
};

struct ReadJob {
  std::shared_ptr<Reads> reads;
  uint64_t request;
};

void runReadJob(void* argument) {
  const std::unique_ptr<ReadJob> job(static_cast<ReadJob*>(argument));
  job->reads->run(job->request);
}

// Of a regular file; -1: errno tells why, 0 of any other kind of file.
int openRegular(const char* path, uint64_t& size) {
  // Without O_NONBLOCK a pipe without a writer would hang here.
  const int descriptor = ::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return -1;
  struct stat status {};
  const bool isKnown = ::fstat(descriptor, &status) == 0;
  if (isKnown && S_ISREG(status.st_mode)) {
    size = static_cast<uint64_t>(status.st_size);
    return descriptor;
  }
  const int cause = isKnown ? 0 : errno;
  ::close(descriptor);
  errno = cause;
  return -1;
}

}  // namespace

struct FrothFile {
  std::shared_ptr<Reads> reads;
  std::string name;
  uint64_t offset;
  FrothRunJob runJob;
  void* jobUser;
  FrothReader reader;
};

namespace {

void startRead(void* user, uint64_t request, uint64_t offset, uint64_t size, void* destination) {
  const FrothFile& file = *static_cast<FrothFile*>(user);
  try {
    file.reads->add(request, {file.offset + offset, size, destination});
    if (!file.runJob) return file.reads->run(request);
    auto job = std::make_unique<ReadJob>(file.reads, request);
    file.runJob(file.jobUser, runReadJob, job.release());
  } catch (const std::bad_alloc&) {
    file.reads->refuse(request);
  }
}

void cancelRead(void* user, uint64_t request) { static_cast<FrothFile*>(user)->reads->cancel(request); }

}  // namespace

FrothResult frothOpenFile(FrothContext* context, const FrothFileInfo* given, FrothFile** file) {
  if (!file) return FROTH_ERROR_ARGUMENT;
  *file = nullptr;
  if (!context || !given || given->structSize < sizeof(uint32_t) || given->structSize > sizeof(*given)) {
    return FROTH_ERROR_ARGUMENT;
  }
  FrothFileInfo info{};  // of an older header: fields that it lacks are zero
  std::memcpy(&info, given, given->structSize);
  if (!info.path) return FROTH_ERROR_ARGUMENT;
  uint64_t fileSize = 0;
  const int descriptor = openRegular(info.path, fileSize);
  if (descriptor < 0) return FROTH_ERROR_FILE;
  try {
    auto reads = std::make_shared<Reads>(context, descriptor);
    if (info.offset >= fileSize || info.size > fileSize - info.offset) return FROTH_ERROR_ARGUMENT;
    const uint64_t size = info.size > 0 ? info.size : fileSize - info.offset;
    auto made =
        std::make_unique<FrothFile>(FrothFile{std::move(reads), info.path, info.offset, info.runJob, info.jobUser, {}});
    made->reader = {sizeof(FrothReader), made.get(), made->name.c_str(), size, startRead, cancelRead};
    *file = made.release();
    return FROTH_OK;
  } catch (const std::bad_alloc&) {
    return FROTH_ERROR_MEMORY;
  }
}

const FrothReader* frothGetFileReader(const FrothFile* file) { return file ? &file->reader : nullptr; }

void frothCloseFile(FrothFile* file) {
  if (!file) return;
  file->reads->finish();
  delete file;
}
