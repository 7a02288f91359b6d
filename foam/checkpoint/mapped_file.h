// A file's bytes without a copy of them in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "base/result.h"

namespace froth {

// Read-only mapping of a whole file; moves, does not copy. A file that another program shortens meanwhile
// cannot be read safely by any mapping: the process then ends with SIGBUS.
class MappedFile {
 public:
  // Fails with kBadInput if the path does not exist, is no regular file, is empty or cannot be read.
  static Result<MappedFile> open(const std::filesystem::path& path);

  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  ~MappedFile();

  std::span<const uint8_t> bytes() const { return bytes_; }

 private:
  explicit MappedFile(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  std::span<const uint8_t> bytes_;
};

}  // namespace froth
