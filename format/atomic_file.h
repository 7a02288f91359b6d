// Whole-file input and output that never leaves a half-written file behind.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "format/result.h"

namespace froth {

// Fails with ErrorKind::kBadInput if the path does not exist, is a directory or cannot be read.
Result<std::vector<uint8_t>> readFile(const std::filesystem::path& path);

// Fails with ErrorKind::kIo if `path` is something else than a regular file, which no file may replace. Part
// of froth_format_write.
Status checkTarget(const std::filesystem::path& path);

// Writes to a temporary name in the same folder, syncs, renames over `path`. On failure the old file is
// intact and the temporary is removed. Part of froth_format_write.
Status writeFileAtomically(const std::filesystem::path& path, std::span<const uint8_t> bytes);

// Takes bytes from front to back. After an error nothing more may be given to it.
using ByteSink = std::function<Status(std::span<const uint8_t>)>;

// The same for contents too large to gather first: `produce` gets a sink that appends to the temporary. Its
// first error is returned. Part of froth_format_write.
Status streamFileAtomically(const std::filesystem::path& path,
                            const std::function<Status(const ByteSink&)>& produce);

}  // namespace froth
