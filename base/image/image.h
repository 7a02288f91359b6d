// Images in memory and on disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/result.h"

namespace froth {

// Row-major from the top left, channels interleaved.
struct Image {
  uint32_t width = 0, height = 0, channels = 0;  // channels: 1 or 3
  std::vector<float> values;                     // [height * width * channels]

  float* pixel(uint32_t x, uint32_t y) { return &values[(size_t{y} * width + x) * channels]; }
  const float* pixel(uint32_t x, uint32_t y) const { return &values[(size_t{y} * width + x) * channels]; }
};

// By extension: .pfm (float), .png (8 bit, 16 bit is read too; transparency lies over black), .jpg, and .f16 (raw
// little-endian half without a header: `shape` gives width and height, channels follow from the file's length).
Result<Image> readImage(const std::filesystem::path& path, const Image* shape = nullptr);

// .pfm keeps the floats, .png clamps to 0..1 and rounds to 8 bits. Written to a temporary name, synced, renamed.
Status writeImage(const std::filesystem::path& path, const Image& image);

}  // namespace froth
