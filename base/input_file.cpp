#include "base/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/atomic_file.h"

namespace froth {

Result<InputFile> InputFile::open(const std::filesystem::path& path) {
  InputFile file;
  file.name_ = path.string();
  const char* name = file.name_.c_str();
  // Without O_NONBLOCK a pipe without a writer would hang here.
  file.descriptor_ = ::open(name, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file.descriptor_ < 0) {
    return makeError(ErrorKind::kBadInput, "%s: cannot be opened: %s; check the path", name, std::strerror(errno));
  }
  struct stat info {};
  if (::fstat(file.descriptor_, &info) != 0) {
    return makeError(ErrorKind::kBadInput, "%s: cannot be examined: %s", name, std::strerror(errno));
  }
  if (S_ISDIR(info.st_mode)) return makeError(ErrorKind::kBadInput, "%s: is a directory; give a file", name);
  if (!S_ISREG(info.st_mode)) return makeError(ErrorKind::kBadInput, "%s: is no regular file; give a file", name);
  file.size_ = static_cast<uint64_t>(info.st_size);
  return file;
}

InputFile::InputFile(InputFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_), name_(std::move(other.name_)) {}

InputFile& InputFile::operator=(InputFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  std::swap(name_, other.name_);
  return *this;
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Status InputFile::readAt(uint64_t offset, std::span<uint8_t> out) const {
  constexpr size_t kMostAtOnce = size_t{1} << 30;  // Linux reads at most 2 GiB by one call
  while (!out.empty()) {
    const size_t wanted = std::min(out.size(), kMostAtOnce);
    const ssize_t got = ::pread(descriptor_, out.data(), wanted, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return makeError(ErrorKind::kBadInput, "%s: cannot be read: %s", name_.c_str(), std::strerror(errno));
    if (got == 0) {
      return makeError(ErrorKind::kBadInput, "%s: became shorter while it was read; try again", name_.c_str());
    }
    offset += static_cast<uint64_t>(got);
    out = out.subspan(static_cast<size_t>(got));
  }
  return {};
}

Result<std::vector<uint8_t>> readFile(const std::filesystem::path& path, uint64_t mostBytes) {
  Result<InputFile> file = InputFile::open(path);
  if (!file) return file.error();
  using ull = unsigned long long;
  if (file->size() > mostBytes) {
    return makeError(ErrorKind::kBadInput, "%s: has %llu bytes, more than %llu; give a smaller file",
                     file->name().c_str(), ull{file->size()}, ull{mostBytes});
  }
  std::vector<uint8_t> bytes(file->size());
  if (Status status = file->readAt(0, bytes); !status) return status.error();
  return bytes;
}

}  // namespace froth
