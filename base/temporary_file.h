// Files under temporary names beside the file that they shall become. Part of froth_format_write.
//
// A run that is killed leaves its temporary behind; the next one that writes the same file removes it.
// Temporaries are locked as long as their process lives, so two runs at once leave each other's alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "base/result.h"

namespace froth {

// "scene.froth: cannot be written: No space left on device; check folder, rights and free space", from errno.
Error ioError(const std::filesystem::path& path, const char* what);

// A file that is removed again unless it was renamed over its target. After an error nothing more may be
// asked of it.
class TemporaryFile {
 public:
  // Beside `target`, so that renaming stays within one file system; beside the file that it names, if it is a symbolic
  // link. Removes leftovers of killed runs first. Has owner and rights of an existing target, as far as the system
  // allows.
  static Result<TemporaryFile> create(const std::filesystem::path& target);
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&& other) noexcept;
  ~TemporaryFile();

  Status append(std::span<const uint8_t> bytes);
  uint64_t size() const { return size_; }  // [bytes]
  // Appends a part of another one, [bytes].
  Status appendPart(const TemporaryFile& source, uint64_t begin, uint64_t size);
  // Takes the name away: the file lives until it is closed, and no killed run leaves it behind.
  void removeName();
  // Syncs and renames over the target.
  Status replaceTarget();

 private:
  TemporaryFile() = default;
  Status openLocked();
  void takeRightsOfTarget() const;

  std::filesystem::path target_;
  std::string name_;  // empty: it has none
  int descriptor_ = -1;
  uint64_t size_ = 0;
};

}  // namespace froth
