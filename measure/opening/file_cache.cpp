#include "measure/opening/file_cache.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace froth {
namespace {

// Closes what it opened.
class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path) : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }

 private:
  int number_;
};

Error errorOf(const std::filesystem::path& path, int cause) {
  return makeError(ErrorKind::kBadInput, "%s: cannot be opened: %s; check the path", path.c_str(),
                   std::strerror(cause));
}

}  // namespace

Status dropFromCache(const std::filesystem::path& path) {
  const Descriptor file(path);
  if (file.number() < 0) return errorOf(path, errno);
  ::fdatasync(file.number());  // pages that are not on the disk yet would stay
  if (const int fault = ::posix_fadvise(file.number(), 0, 0, POSIX_FADV_DONTNEED); fault != 0) {
    return errorOf(path, fault);
  }
  return {};
}

Result<double> cachedShareOf(const std::filesystem::path& path) {
  const Descriptor file(path);
  const off_t end = file.number() < 0 ? -1 : ::lseek(file.number(), 0, SEEK_END);
  if (end < 0) return errorOf(path, errno);
  if (end == 0) return 0.0;
  const auto size = static_cast<size_t>(end);
  void* const mapped = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.number(), 0);
  if (mapped == MAP_FAILED) return errorOf(path, errno);
  const auto page = static_cast<size_t>(::sysconf(_SC_PAGESIZE));
  std::vector<unsigned char> pages((size + page - 1) / page);
  const int asked = ::mincore(mapped, size, pages.data());
  const int fault = errno;
  ::munmap(mapped, size);
  if (asked != 0) return errorOf(path, fault);
  const auto kept = std::count_if(pages.begin(), pages.end(), [](unsigned char bits) { return (bits & 1) != 0; });
  return static_cast<double>(kept) / static_cast<double>(pages.size());
}

}  // namespace froth
