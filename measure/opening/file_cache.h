// What the operating system keeps of a file in memory.
#pragma once

#include <filesystem>

#include "base/result.h"

namespace froth {

// Asks for none of it to be kept. Without effect on file systems that live in memory, and on pages that are mapped.
Status dropFromCache(const std::filesystem::path& path);

Result<double> cachedShareOf(const std::filesystem::path& path);  // [0..1]

}  // namespace froth
