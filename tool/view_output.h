// Where the pictures of a command go.
#pragma once

#include <filesystem>
#include <vector>

#include "base/image/image.h"
#include "base/result.h"
#include "reference/capture/view_selection.h"

namespace froth {

// One view goes to the file `output`, all views into the folder `output` as view_00.pfm, view_01.pfm ...
// Fails if `output` does not name what is asked for, before anything is drawn.
Result<std::vector<std::filesystem::path>> outputPaths(const ViewOptions& options,
                                                       const std::vector<SelectedView>& views,
                                                       const std::filesystem::path& output);

// Writes an image whose folder may not exist yet.
Status writeOutput(const std::filesystem::path& path, const Image& image);

}  // namespace froth
