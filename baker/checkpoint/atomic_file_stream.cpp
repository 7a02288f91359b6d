#include "baker/checkpoint/atomic_file_stream.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <unistd.h>

namespace froth {
namespace {

Error ioError(const std::filesystem::path& path, const char* what) {
  return makeError(ErrorKind::kIo, "%s: %s: %s; check folder, rights and free space", path.c_str(), what,
                   std::strerror(errno));
}

Status writeAll(int descriptor, const std::filesystem::path& path, std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) {
      return ioError(path, "cannot be written");
    }
    bytes = bytes.subspan(written < 0 ? 0 : static_cast<size_t>(written));
  }
  return {};
}

// So that the new name survives a power cut. Best effort: not every file system can do it.
void syncFolderOf(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0) {
    ::fsync(descriptor);
    ::close(descriptor);
  }
}

}  // namespace

Status streamFileAtomically(const std::filesystem::path& path,
                            const std::function<Status(const ByteSink&)>& produce) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored)) {
    return makeError(ErrorKind::kIo, "%s: exists and is no regular file; give another name", path.c_str());
  }
  const std::filesystem::path temporary = path.string() + ".tmp-" + std::to_string(::getpid());
  ::unlink(temporary.c_str());  // a process of this number may have been killed here
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    return ioError(temporary, "cannot be created");
  }
  Status status =
      produce([&](std::span<const uint8_t> bytes) { return writeAll(descriptor, temporary, bytes); });
  if (status && ::fsync(descriptor) != 0) {
    status = ioError(temporary, "cannot be synced");
  }
  if (::close(descriptor) != 0 && status) {
    status = ioError(temporary, "cannot be closed");
  }
  if (status && std::rename(temporary.c_str(), path.c_str()) != 0) {
    status = ioError(path, "cannot be replaced");
  }
  if (!status) {
    ::unlink(temporary.c_str());
    return status;
  }
  syncFolderOf(path);
  return {};
}

}  // namespace froth
