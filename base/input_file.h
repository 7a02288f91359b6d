// A regular file open for reading at any place.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "base/result.h"

namespace froth {

// Keeps reading the same file when another one is renamed over its path.
// Thread safety: readAt() may run on several threads at once.
class InputFile {
 public:
  // Fails with ErrorKind::kBadInput if the path does not exist, is no regular file or cannot be read.
  static Result<InputFile> open(const std::filesystem::path& path);

  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&& other) noexcept;
  ~InputFile();

  uint64_t size() const { return size_; }  // [bytes] when it was opened
  const std::string& name() const { return name_; }
  // Fills `out` from byte `offset` on.
  Status readAt(uint64_t offset, std::span<uint8_t> out) const;

 private:
  InputFile() = default;
  int descriptor_ = -1;
  uint64_t size_ = 0;
  std::string name_;
};

}  // namespace froth
