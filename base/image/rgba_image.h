// Photos and masks as their files hold them: 8 bits a channel, four channels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"

namespace froth {

struct ImageSize {
  uint32_t width = 0, height = 0;
};

// Row-major from the top left. 16 bits are rounded to 8, grey is repeated, palettes are looked up. Colour is what the
// file says: straight or premultiplied.
struct RgbaImage {
  uint32_t width = 0, height = 0;
  bool hasAlpha = false;        // false: alpha is 255 everywhere
  std::vector<uint8_t> values;  // [height * width * 4]
};

// A JPEG or PNG file, told by its first bytes and not by its name. Rows are as stored: an EXIF orientation is not
// applied. Fails with kBadInput: no such file, another format, CMYK, a file cut short.
Result<RgbaImage> readRgbaImage(const std::filesystem::path& path);

// The same of a file in memory; `file` heads messages.
Result<RgbaImage> decodeRgbaImage(std::span<const uint8_t> bytes, const std::string& file);

// Decodes the header alone.
Result<ImageSize> readImageSize(const std::filesystem::path& path);

// EXIF's orientation of a JPEG file, 1 to 8: rows are stored so that a viewer has to turn or mirror them, unless it is
// 1. None: the file says nothing.
std::optional<int> exifOrientation(std::span<const uint8_t> jpeg);

}  // namespace froth
