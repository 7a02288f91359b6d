#include "baker/tool/view_selection.h"

#include <charconv>
#include <limits>
#include <system_error>

#include <fmt/format.h>

#include "baker/tool/option_checks.h"

namespace froth {
namespace {

constexpr uint32_t kMaxExtent = 16384;  // of a view of the runtime

struct Size {
  uint32_t width = 0, height = 0;
};

std::optional<Size> parseSize(const std::string& text) {
  Size size;
  const char* end = text.data() + text.size();
  const auto [cross, widthError] = std::from_chars(text.data(), end, size.width);
  if (widthError != std::errc{} || cross == end || *cross != 'x') return std::nullopt;
  const auto [rest, heightError] = std::from_chars(cross + 1, end, size.height);
  if (heightError != std::errc{} || rest != end) return std::nullopt;
  if (size.width == 0 || size.height == 0 || size.width > kMaxExtent || size.height > kMaxExtent)
    return std::nullopt;
  return size;
}

std::string checkSize(const std::string& text) {
  if (parseSize(text)) return {};
  return fmt::format("'{}' is not a size; write WIDTHxHEIGHT, each 1 to {}, as in 1319x989", text,
                     kMaxExtent);
}

bool isImagePath(const std::filesystem::path& path) {
  return path.extension() == ".pfm" || path.extension() == ".png";
}

}  // namespace

void addViewOptions(CLI::App& command, ViewOptions& options) {
  command.add_option("--view", options.view, "Index of one view, from 0; without it all of them")
      ->type_name("I")
      ->check(countBetween(0, std::numeric_limits<uint32_t>::max()));
  command.add_option("--size", options.size, "Size of the images instead of the view's own")
      ->type_name("WxH")
      ->check(CLI::Validator(checkSize, ""));
}

Result<std::vector<SelectedView>> selectViews(const ViewOptions& options) {
  Result<CameraSet> cameras = readCameras(options.cameras);
  if (!cameras) return cameras.error();
  const std::string file = options.cameras.string();
  if (cameras->views.empty()) {
    return makeError(ErrorKind::kBadInput, "%s: field 'views' holds none; a view is needed", file.c_str());
  }
  const size_t count = cameras->views.size();
  if (options.view && *options.view >= count) {
    return makeError(ErrorKind::kUsage, "--view %zu: %s has %zu views; give 0 to %zu", *options.view,
                     file.c_str(), count, count - 1);
  }

  const std::optional<Size> size = parseSize(options.size);
  std::vector<SelectedView> selected;
  for (size_t index = 0; index < count; ++index) {
    if (options.view && *options.view != index) continue;
    const View& view = cameras->views[index];
    selected.push_back({index, size ? resizeView(view, size->width, size->height) : view});
  }
  return selected;
}

Result<std::vector<std::filesystem::path>> outputPaths(const ViewOptions& options,
                                                       const std::vector<SelectedView>& views,
                                                       const std::filesystem::path& output) {
  if (options.view) {
    if (isImagePath(output)) return std::vector{output};
    return makeError(ErrorKind::kUsage, "-o %s: with --view, name an image ending in .pfm or .png",
                     output.c_str());
  }
  std::error_code ignored;
  if (isImagePath(output) ||
      (std::filesystem::exists(output, ignored) && !std::filesystem::is_directory(output, ignored))) {
    return makeError(ErrorKind::kUsage,
                     "-o %s: all views go into a folder; name one, or pick a view with --view",
                     output.c_str());
  }
  std::vector<std::filesystem::path> paths;
  for (const SelectedView& selected : views)
    paths.push_back(output / fmt::format("view_{:02}.pfm", selected.index));
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
