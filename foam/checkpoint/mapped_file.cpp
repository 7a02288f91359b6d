#include "foam/checkpoint/mapped_file.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "foam/checkpoint/bad_input.h"

namespace froth {
namespace {

Result<std::span<const uint8_t>> mapOpenFile(int descriptor, const std::string& name) {
  struct stat status = {};
  if (fstat(descriptor, &status) != 0) {
    return badInput(name, "cannot be read: {}", std::strerror(errno));
  }
  if (!S_ISREG(status.st_mode)) {
    return badInput(name, "is {}, not a file; name a checkpoint such as model.pt",
                    S_ISDIR(status.st_mode) ? "a directory" : "a device or pipe");
  }
  if (status.st_size == 0) {
    return badInput(name, "is empty (0 bytes); expected a checkpoint, copy or save it again");
  }
  const auto size = static_cast<size_t>(status.st_size);
  void* address = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  if (address == MAP_FAILED) {
    return badInput(name, "cannot be mapped ({} bytes): {}", size, std::strerror(errno));
  }
  return std::span(static_cast<const uint8_t*>(address), size);
}

}  // namespace

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
  const int descriptor =
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe without a writer must not block
  if (descriptor < 0) {
    return badInput(path.string(), "cannot be opened: {}; check the path", std::strerror(errno));
  }
  auto mapped = mapOpenFile(descriptor, path.string());
  ::close(descriptor);  // the mapping stays
  if (!mapped) {
    return mapped.error();
  }
  return MappedFile(*mapped);
}

MappedFile::MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) {
    munmap(const_cast<uint8_t*>(bytes_.data()), bytes_.size());
  }
}

}  // namespace froth
