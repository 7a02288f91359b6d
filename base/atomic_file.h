// Whole-file input and output that never leaves a half-written file behind.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "base/result.h"

namespace froth {

// Fails with ErrorKind::kBadInput if the path does not exist, is a directory or cannot be read, or the file has more
// than `mostBytes`.
Result<std::vector<uint8_t>> readFile(const std::filesystem::path& path, uint64_t mostBytes = UINT64_MAX);

// A file that nobody may write (mode 444) is left alone unless its replacement is forced.
enum class WriteProtected { kRefuse, kReplace };

// Fails with ErrorKind::kIo if `path` is something else than a regular file, which no file may replace, or is
// write-protected. Part of froth_format_write.
Status checkTarget(const std::filesystem::path& path, WriteProtected isProtected = WriteProtected::kRefuse);

// Writes to a temporary name in the same folder, syncs, renames over `path`. On failure the old file is
// intact and the temporary is removed. The new file has the rights of the old one; through a symbolic link the
// file that it names is replaced. Part of froth_format_write.
Status writeFileAtomically(const std::filesystem::path& path, std::span<const uint8_t> bytes);

// Takes bytes from front to back. After an error nothing more may be given to it.
using ByteSink = std::function<Status(std::span<const uint8_t>)>;

// The same for contents too large to gather first: `produce` gets a sink that appends to the temporary. Its
// first error is returned. Part of froth_format_write.
Status streamFileAtomically(const std::filesystem::path& path, const std::function<Status(const ByteSink&)>& produce);

}  // namespace froth
