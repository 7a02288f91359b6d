#include "host/picture_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <system_error>

#include <stb_image.h>
#include <stb_image_resize.h>
#include <stb_image_write.h>

namespace froth {
namespace {

constexpr int kChannels = 3;

float displayFromLinear(float value) {  // sRGB, IEC 61966-2-1
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

}  // namespace

Picture8 encodePicture(std::span<const float> rgba, VkExtent2D extent) {
  Picture8 picture{static_cast<int>(extent.width), static_cast<int>(extent.height), {}};
  picture.rgb.reserve(rgba.size() / 4 * kChannels);
  for (size_t texel = 0; texel < rgba.size(); texel += 4) {
    const float coverage = rgba[texel + 3];
    for (size_t channel = 0; channel < kChannels; ++channel) {
      const float shown =
          coverage > 0 ? coverage * displayFromLinear(rgba[texel + channel] / coverage) : 0.0f;
      picture.rgb.push_back(static_cast<uint8_t>(std::clamp(shown, 0.0f, 1.0f) * 255.0f + 0.5f));
    }
  }
  return picture;
}

Status writePicture(const std::filesystem::path& path, const Picture8& picture) {
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  const std::filesystem::path temporary = path.string() + ".partial";
  std::ofstream file(temporary, std::ios::binary);
  const auto append = [](void* stream, void* bytes, int count) {
    static_cast<std::ofstream*>(stream)->write(static_cast<const char*>(bytes), count);
  };
  const bool isEncoded = stbi_write_png_to_func(append, &file, picture.width, picture.height, kChannels,
                                                picture.rgb.data(), picture.width * kChannels) != 0;
  file.close();
  const bool isWritten = isEncoded && file.good();
  if (isWritten) std::filesystem::rename(temporary, path, error);
  if (isWritten && !error) return {};
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  return makeError(ErrorKind::kIo, "%s: cannot be written; check the folder and the free space",
                   path.c_str());
}

Result<Picture8> readPicture(const std::filesystem::path& path) {
  Picture8 picture;
  int channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load(path.c_str(), &picture.width, &picture.height, &channels, kChannels), stbi_image_free);
  if (!pixels) {
    return makeError(ErrorKind::kBadInput, "%s: %s; give a PNG or JPEG", path.c_str(), stbi_failure_reason());
  }
  picture.rgb.assign(pixels.get(), pixels.get() + size_t{kChannels} * picture.width * picture.height);
  return picture;
}

Result<double> comparePictures(const Picture8& a, const Picture8& b) {
  if (a.width != b.width || a.height != b.height) {
    return makeError(ErrorKind::kBadInput, "the pictures are %dx%d and %dx%d; render at the same --size",
                     a.width, a.height, b.width, b.height);
  }
  double sum = 0;
  for (size_t i = 0; i < a.rgb.size(); ++i) {
    const double difference = (a.rgb[i] - b.rgb[i]) / 255.0;
    sum += difference * difference;
  }
  if (sum == 0) return std::numeric_limits<double>::infinity();
  return -10.0 * std::log10(sum / static_cast<double>(a.rgb.size()));
}

Picture8 contactSheet(std::span<const Picture8> pictures) {
  constexpr int kColumns = 4, kMaxThumbnailWidth = 480;
  const Picture8& first = pictures.front();
  const int count = static_cast<int>(pictures.size());
  const int width = std::min(first.width, kMaxThumbnailWidth);
  const int height = std::max(1, first.height * width / first.width);
  const int columns = std::min(count, kColumns), rows = (count + columns - 1) / columns;

  Picture8 sheet{columns * width, rows * height, {}};
  sheet.rgb.resize(size_t{kChannels} * sheet.width * sheet.height);
  for (int i = 0; i < count; ++i) {
    const size_t corner =
        size_t{kChannels} * (size_t(i / columns) * height * sheet.width + size_t(i % columns) * width);
    const Picture8& picture = pictures[static_cast<size_t>(i)];
    stbir_resize_uint8_srgb(picture.rgb.data(), picture.width, picture.height, picture.width * kChannels,
                            sheet.rgb.data() + corner, width, height, sheet.width * kChannels, kChannels,
                            STBIR_ALPHA_CHANNEL_NONE, 0);
  }
  return sheet;
}

}  // namespace froth
