#include "tool/view_output.h"

#include <system_error>

#include <fmt/format.h>

namespace froth {
namespace {

bool isImagePath(const std::filesystem::path& path) { return path.extension() == ".pfm" || path.extension() == ".png"; }

}  // namespace

Result<std::vector<std::filesystem::path>> outputPaths(const ViewOptions& options,
                                                       const std::vector<SelectedView>& views,
                                                       const std::filesystem::path& output) {
  if (options.view) {
    if (isImagePath(output)) return std::vector{output};
    return makeError(ErrorKind::kUsage, "-o %s: with --view, name an image ending in .pfm or .png", output.c_str());
  }
  std::error_code ignored;
  if (isImagePath(output) ||
      (std::filesystem::exists(output, ignored) && !std::filesystem::is_directory(output, ignored))) {
    return makeError(ErrorKind::kUsage, "-o %s: all views go into a folder; name one, or pick a view with --view",
                     output.c_str());
  }
  std::vector<std::filesystem::path> paths;
  for (const SelectedView& selected : views) paths.push_back(output / fmt::format("view_{:02}.pfm", selected.index));
  return paths;
}

Status writeOutput(const std::filesystem::path& path, const Image& image) {
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  if (error) {
    return makeError(ErrorKind::kIo, "%s: %s; choose another folder", path.parent_path().c_str(),
                     error.message().c_str());
  }
  return writeImage(path, image);
}

}  // namespace froth
