// Which views of a camera file are drawn, and at which size.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "reference/camera/camera.h"

namespace froth {

struct ViewOptions {
  std::filesystem::path cameras;
  std::optional<size_t> view;  // absent: all
  std::string size;            // "WxH"; empty: as cameras.json says
};

// Why a text is no ViewOptions::size; empty: it is one.
std::string checkSize(const std::string& text);

struct SelectedView {
  size_t index = 0;  // in cameras.json
  View view;         // at the size asked for
};

Result<std::vector<SelectedView>> selectViews(const ViewOptions& options);

}  // namespace froth
