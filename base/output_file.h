// Where a command writes.
#pragma once

#include <filesystem>

#include "base/atomic_file.h"
#include "base/result.h"

namespace froth {

// Fails where `path` could not be written, so that long work does not find out at its end.
Status checkWritable(const std::filesystem::path& path, WriteProtected isProtected = WriteProtected::kRefuse);

}  // namespace froth
