// A file written front to back: for contents too large to gather first, as format/atomic_file.h asks for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "format/result.h"

namespace froth {

// Takes bytes from front to back. After an error nothing more may be given to it.
using ByteSink = std::function<Status(std::span<const uint8_t>)>;

// Runs `produce` with a sink that appends to a temporary name in the folder of `path`; if all went well,
// syncs and renames it over `path`. Otherwise the old file is intact, the temporary is removed, and the first
// error is returned (kIo for the file's own). Two threads must not write the same path at the same time.
Status streamFileAtomically(const std::filesystem::path& path,
                            const std::function<Status(const ByteSink&)>& produce);

}  // namespace froth
