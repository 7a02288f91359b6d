// The file formats behind readImage and writeImage. Decoders take the whole file and trust nothing in it: a
// declared size is tested against the limits below and against what that many bytes can hold before memory is
// taken for it. `file` heads error messages.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/image/image.h"
#include "base/image/rgba_image.h"
#include "base/result.h"

namespace froth {

constexpr uint32_t kMaxImageSide = 65536;
constexpr uint64_t kMaxImagePixels = uint64_t{1} << 28;

// Fails with kBadInput outside 1..kMaxImageSide, above kMaxImagePixels, or above what `byteCount` bytes can
// encode.
Status checkImageSize(const std::string& file, uint64_t width, uint64_t height, double maxPixelsPerByte,
                      size_t byteCount);

Result<Image> decodePfm(std::span<const uint8_t> bytes, const std::string& file);
Result<Image> decodePng(std::span<const uint8_t> bytes, const std::string& file);
Result<Image> decodeJpeg(std::span<const uint8_t> bytes, const std::string& file);

Result<RgbaImage> decodeRgbaPng(std::span<const uint8_t> bytes, const std::string& file);
Result<RgbaImage> decodeRgbaJpeg(std::span<const uint8_t> bytes, const std::string& file);

// Of the header alone.
Result<ImageSize> pngSize(std::span<const uint8_t> bytes, const std::string& file);
Result<ImageSize> jpegSize(std::span<const uint8_t> bytes, const std::string& file);

std::vector<uint8_t> encodePfm(const Image& image);
Result<std::vector<uint8_t>> encodePng(const Image& image, const std::string& file);

}  // namespace froth
