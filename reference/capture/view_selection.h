// Where views come from, which of them are drawn, and at which size.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "reference/camera/camera.h"

namespace froth {

// The views of cameras.json, or of a capture: a COLMAP folder or transforms.json (capture.h). Photos need not be there,
// unless a transforms.json leaves their size to them.
Result<CameraSet> readViews(const std::filesystem::path& path);

struct ViewOptions {
  std::filesystem::path cameras;  // as readViews() takes it
  std::optional<size_t> view;     // absent: all
  std::string size;               // "WxH"; empty: as the views say
};

// Why a text is no ViewOptions::size; empty: it is one.
std::string checkSize(const std::string& text);

struct SelectedView {
  size_t index = 0;  // of readViews()
  View view;         // at the size asked for
};

Result<std::vector<SelectedView>> selectViews(const ViewOptions& options);

}  // namespace froth
