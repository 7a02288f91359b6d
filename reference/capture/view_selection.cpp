#include "reference/capture/view_selection.h"

#include <charconv>
#include <system_error>

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "base/json_input.h"
#include "reference/capture/capture.h"

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
  if (size.width == 0 || size.height == 0 || size.width > kMaxExtent || size.height > kMaxExtent) return std::nullopt;
  return size;
}

// Whether a file is a transforms.json: it has frames where cameras.json has views.
Result<bool> hasFrames(const std::filesystem::path& path) {
  const Result<std::vector<uint8_t>> bytes = readFile(path, kMostJsonBytes);
  if (!bytes) return bytes.error();
  const Result<nlohmann::json> root = parseJson(*bytes, path.string(), "give cameras.json or transforms.json");
  if (!root) return root.error();
  return root->is_object() && root->contains("frames") && !root->contains("views");
}

}  // namespace

Result<CameraSet> readViews(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) {
    const Result<bool> isTransforms = hasFrames(path);
    if (!isTransforms) return isTransforms.error();
    if (!*isTransforms) return readCameras(path);
  }
  Result<Capture> capture = readCapture(path);
  if (!capture) return capture.error();
  CameraSet cameras;
  for (CapturedView& view : capture->views) cameras.views.push_back(std::move(view.view));
  return cameras;
}

std::string checkSize(const std::string& text) {
  if (parseSize(text)) return {};
  return fmt::format("'{}' is not a size; write WIDTHxHEIGHT, each 1 to {}, as in 1319x989", text, kMaxExtent);
}

Result<std::vector<SelectedView>> selectViews(const ViewOptions& options) {
  Result<CameraSet> cameras = readViews(options.cameras);
  if (!cameras) return cameras.error();
  const std::string file = options.cameras.string();
  if (cameras->views.empty()) {
    return makeError(ErrorKind::kBadInput, "%s: field 'views' holds none; a view is needed", file.c_str());
  }
  const size_t count = cameras->views.size();
  if (options.view && *options.view >= count) {
    return makeError(ErrorKind::kUsage, "--view %zu: %s has %zu views; give 0 to %zu", *options.view, file.c_str(),
                     count, count - 1);
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

}  // namespace froth
