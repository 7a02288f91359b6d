#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "format/atomic_file.h"

namespace froth {
namespace {

// A file that is removed again unless it was renamed.
class TemporaryFile {
 public:
  // Beside `target`, so that renaming stays within one file system.
  explicit TemporaryFile(const std::filesystem::path& target) {
    constexpr int kAttempts = 100;  // names that another thread, or a process that was killed, may hold
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      path_ = target.string() + ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(attempt);
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ >= 0 || errno != EEXIST) break;
    }
    exists_ = descriptor_ >= 0;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    close();
    if (exists_) ::unlink(path_.c_str());
  }

  bool isOpen() const { return exists_; }

  bool append(std::span<const uint8_t> bytes) {
    while (!bytes.empty()) {
      const ssize_t done = ::write(descriptor_, bytes.data(), bytes.size());
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) return false;
      bytes = bytes.subspan(static_cast<size_t>(done));
    }
    return true;
  }

  bool finish() { return ::fsync(descriptor_) == 0 && close(); }

  bool renameTo(const std::filesystem::path& target) {
    if (std::rename(path_.c_str(), target.c_str()) != 0) return false;
    exists_ = false;
    return true;
  }

 private:
  bool close() {
    const int descriptor = std::exchange(descriptor_, -1);
    return descriptor < 0 || ::close(descriptor) == 0;
  }

  std::string path_;
  int descriptor_ = -1;
  bool exists_ = false;
};

Error ioError(const std::filesystem::path& path, const char* what) {
  return makeError(ErrorKind::kIo, "%s: %s: %s; check folder, rights and free space", path.c_str(), what,
                   std::strerror(errno));
}

// So that the new name survives a power cut. Best effort: not every file system can do it.
void syncFolderOf(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

Status streamFileAtomically(const std::filesystem::path& path, const std::function<Status(const ByteSink&)>& produce) {
  std::error_code ignored;
  const std::filesystem::file_status old = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(old) && !std::filesystem::is_regular_file(old))
    return makeError(ErrorKind::kIo, "%s: exists and is no regular file; give another name", path.c_str());
  TemporaryFile temporary(path);
  if (!temporary.isOpen()) return ioError(path, "cannot be created");
  const Status produced = produce([&](std::span<const uint8_t> bytes) -> Status {
    if (!temporary.append(bytes)) return ioError(path, "cannot be written");
    return {};
  });
  if (!produced) return produced;
  if (!temporary.finish()) return ioError(path, "cannot be synced");
  if (!temporary.renameTo(path)) return ioError(path, "cannot be replaced");
  syncFolderOf(path);
  return {};
}

Status writeFileAtomically(const std::filesystem::path& path, std::span<const uint8_t> bytes) {
  return streamFileAtomically(path, [&](const ByteSink& sink) { return sink(bytes); });
}

}  // namespace froth
