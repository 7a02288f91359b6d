// Which views a command draws, and where the pictures go.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "baker/camera/camera.h"
#include "baker/image/image.h"
#include "format/result.h"

namespace froth {

struct ViewOptions {
  std::filesystem::path cameras;
  std::optional<size_t> view;  // absent: all
  std::string size;            // "WxH"; empty: as cameras.json says
};

void addViewOptions(CLI::App& command, ViewOptions& options);

struct SelectedView {
  size_t index = 0;  // in cameras.json
  View view;         // at the size asked for
};

Result<std::vector<SelectedView>> selectViews(const ViewOptions& options);

// One view goes to the file `output`, all views into the folder `output` as view_00.pfm, view_01.pfm ...
// Fails if `output` does not name what is asked for, before anything is drawn.
Result<std::vector<std::filesystem::path>> outputPaths(const ViewOptions& options,
                                                       const std::vector<SelectedView>& views,
                                                       const std::filesystem::path& output);

// Writes an image whose folder may not exist yet.
Status writeOutput(const std::filesystem::path& path, const Image& image);

}  // namespace froth
