// Reads key poses from cameras.json (docs/CAMERAS.md).
#pragma once

#include <filesystem>
#include <vector>

#include "host/camera_path.h"
#include "host/host.h"

namespace froth {

// The flight path, or, in a file without one, the test views in their order. At least one pose.
Result<std::vector<Pose>> readKeyPoses(const std::filesystem::path& path);

}  // namespace froth
