#include "base/image/rgba_image.h"

#include <algorithm>
#include <string_view>

#include "base/atomic_file.h"
#include "base/image/formats.h"

namespace froth {
namespace {

enum class PhotoFormat { kJpeg, kPng };

bool startsWith(std::span<const uint8_t> bytes, std::string_view start) {
  return bytes.size() >= start.size() && std::equal(start.begin(), start.end(), bytes.begin(),
                                                    [](char a, uint8_t b) { return static_cast<uint8_t>(a) == b; });
}

Result<PhotoFormat> formatOf(std::span<const uint8_t> bytes, const std::string& file) {
  if (startsWith(bytes, "\x89PNG\r\n\x1a\n")) return PhotoFormat::kPng;
  if (startsWith(bytes, "\xff\xd8\xff")) return PhotoFormat::kJpeg;
  if (startsWith(bytes, "version https://git-lfs")) {
    return makeError(ErrorKind::kBadInput, "%s: found a pointer of Git LFS instead of an image; run 'git lfs pull'",
                     file.c_str());
  }
  return makeError(ErrorKind::kBadInput, "%s: found %s; give a JPEG or PNG image", file.c_str(),
                   bytes.empty() ? "an empty file" : "neither a JPEG nor a PNG header");
}

uint32_t readNumber(std::span<const uint8_t> bytes, size_t at, size_t count, bool isLittle) {
  uint32_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + (isLittle ? count - 1 - i : i)];
  return value;
}

// Of a TIFF structure as EXIF has it: the first directory's tag 0x0112.
std::optional<int> tiffOrientation(std::span<const uint8_t> tiff) {
  constexpr size_t kHeader = 8, kEntry = 12;
  constexpr uint32_t kOrientationTag = 0x0112;
  if (tiff.size() < kHeader) return std::nullopt;
  const bool isLittle = tiff[0] == 'I';
  const size_t directory = readNumber(tiff, 4, 4, isLittle);
  if (directory > tiff.size() || tiff.size() - directory < 2) return std::nullopt;
  const size_t room = (tiff.size() - directory - 2) / kEntry;
  const size_t count = std::min<size_t>(readNumber(tiff, directory, 2, isLittle), room);
  for (size_t i = 0; i < count; ++i) {
    const size_t entry = directory + 2 + i * kEntry;
    if (readNumber(tiff, entry, 2, isLittle) != kOrientationTag) continue;
    const uint32_t value = readNumber(tiff, entry + 8, 2, isLittle);
    return value >= 1 && value <= 8 ? std::optional<int>(value) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

Result<RgbaImage> readRgbaImage(const std::filesystem::path& path) {
  const Result<std::vector<uint8_t>> bytes = readFile(path);
  if (!bytes) return bytes.error();
  return decodeRgbaImage(*bytes, path.string());
}

Result<RgbaImage> decodeRgbaImage(std::span<const uint8_t> bytes, const std::string& file) {
  const Result<PhotoFormat> format = formatOf(bytes, file);
  if (!format) return format.error();
  return *format == PhotoFormat::kPng ? decodeRgbaPng(bytes, file) : decodeRgbaJpeg(bytes, file);
}

Result<ImageSize> readImageSize(const std::filesystem::path& path) {
  const Result<std::vector<uint8_t>> bytes = readFile(path);
  if (!bytes) return bytes.error();
  const Result<PhotoFormat> format = formatOf(*bytes, path.string());
  if (!format) return format.error();
  return *format == PhotoFormat::kPng ? pngSize(*bytes, path.string()) : jpegSize(*bytes, path.string());
}

std::optional<int> exifOrientation(std::span<const uint8_t> jpeg) {
  constexpr std::string_view kExif{"Exif\0\0", 6};
  constexpr uint8_t kApp1 = 0xe1, kStartOfScan = 0xda;
  size_t at = 2;  // after the start of the image
  while (jpeg.size() >= at + 4 && jpeg[at] == 0xff && jpeg[at + 1] != kStartOfScan) {
    const size_t size = readNumber(jpeg, at + 2, 2, false);
    if (size < 2 || jpeg.size() - at - 2 < size) break;
    const std::span<const uint8_t> segment = jpeg.subspan(at + 4, size - 2);
    if (jpeg[at + 1] == kApp1 && startsWith(segment, kExif)) return tiffOrientation(segment.subspan(kExif.size()));
    at += 2 + size;
  }
  return std::nullopt;
}

}  // namespace froth
