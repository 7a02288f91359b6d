#include "host/picture_file.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include "base/image/mean_square.h"

namespace froth {
namespace {

constexpr uint32_t kChannels = 3;

float displayFromLinear(float value) {  // sRGB, IEC 61966-2-1
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

// The mean of what `picture` has under pixel (x, y) of a width x height thumbnail.
void shrink(const Image& picture, uint32_t x, uint32_t y, uint32_t width, uint32_t height, float* pixel) {
  const uint32_t left = x * picture.width / width, right = (x + 1) * picture.width / width;
  const uint32_t top = y * picture.height / height, bottom = (y + 1) * picture.height / height;
  const float share = 1.0f / float((right - left) * (bottom - top));
  for (uint32_t row = top; row < bottom; ++row) {
    for (uint32_t column = left; column < right; ++column) {
      for (uint32_t c = 0; c < kChannels; ++c) pixel[c] += share * picture.pixel(column, row)[c];
    }
  }
}

}  // namespace

Image encodePicture(std::span<const float> rgba, VkExtent2D extent) {
  Image picture{extent.width, extent.height, kChannels, {}};
  picture.values.reserve(rgba.size() / 4 * kChannels);
  for (size_t texel = 0; texel < rgba.size(); texel += 4) {
    const float coverage = rgba[texel + 3];
    for (size_t channel = 0; channel < kChannels; ++channel) {
      const float shown = coverage > 0 ? coverage * displayFromLinear(rgba[texel + channel] / coverage) : 0.0f;
      picture.values.push_back(std::floor(std::clamp(shown, 0.0f, 1.0f) * 255.0f + 0.5f) / 255.0f);
    }
  }
  return picture;
}

Status writePicture(const std::filesystem::path& path, const Image& picture) {
  std::error_code ignored;  // writeImage() says what is wrong with the folder
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), ignored);
  return writeImage(path, picture);
}

Result<double> comparePictures(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels) {
    return makeError(ErrorKind::kBadInput,
                     "the pictures are %ux%u and %ux%u, with %u and %u channels; render at the same --size", a.width,
                     a.height, b.width, b.height, a.channels, b.channels);
  }
  return decibels(meanSquare(a, b));
}

Image contactSheet(std::span<const Image> pictures) {
  constexpr uint32_t kColumns = 4, kMaxThumbnailWidth = 480;
  const Image& first = pictures.front();
  const uint32_t count = static_cast<uint32_t>(pictures.size());
  const uint32_t width = std::min(first.width, kMaxThumbnailWidth);
  const uint32_t height = std::max(1u, first.height * width / first.width);
  const uint32_t columns = std::min(count, kColumns), rows = (count + columns - 1) / columns;

  Image sheet{columns * width, rows * height, kChannels, {}};
  sheet.values.resize(size_t{sheet.width} * sheet.height * kChannels);
  for (uint32_t i = 0; i < count; ++i) {
    for (uint32_t y = 0; y < height; ++y) {
      for (uint32_t x = 0; x < width; ++x) {
        shrink(pictures[i], x, y, width, height, sheet.pixel(i % columns * width + x, i / columns * height + y));
      }
    }
  }
  return sheet;
}

}  // namespace froth
