#include "base/image/image.h"

#include <algorithm>
#include <cctype>
#include <glm/gtc/packing.hpp>

#include "base/atomic_file.h"
#include "base/image/formats.h"

namespace froth {
namespace {

std::string lowerExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

// Raw halves carry no header: width and height come from `shape`, channels from the length.
Result<Image> decodeHalves(std::span<const uint8_t> bytes, const Image* shape, const std::string& file) {
  if (!shape || shape->width == 0 || shape->height == 0) {
    return makeError(ErrorKind::kUsage, "%s: raw halves carry no size; compare them with an image that does",
                     file.c_str());
  }
  const uint64_t pixels = uint64_t{shape->width} * shape->height;
  const uint64_t channels = bytes.size() / 2 / pixels;
  if ((channels != 1 && channels != 3) || bytes.size() != pixels * channels * 2) {
    return makeError(ErrorKind::kBadInput,
                     "%s: found %zu bytes; %u x %u halves need %llu (1 channel) or %llu (3 channels)", file.c_str(),
                     bytes.size(), shape->width, shape->height, static_cast<unsigned long long>(pixels * 2),
                     static_cast<unsigned long long>(pixels * 6));
  }
  Image image{shape->width, shape->height, static_cast<uint32_t>(channels), std::vector<float>(pixels * channels)};
  for (size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = glm::unpackHalf1x16(static_cast<uint16_t>(bytes[2 * i] | bytes[2 * i + 1] << 8));
  }
  return image;
}

}  // namespace

Status checkImageSize(const std::string& file, uint64_t width, uint64_t height, double maxPixelsPerByte,
                      size_t byteCount) {
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide || width * height > kMaxImagePixels) {
    return makeError(ErrorKind::kBadInput,
                     "%s: header: size %llu x %llu; give 1 to 65536 pixels a side and at most 2^28 in all",
                     file.c_str(), static_cast<unsigned long long>(width), static_cast<unsigned long long>(height));
  }
  if (double(width) * double(height) > maxPixelsPerByte * double(byteCount)) {
    return makeError(
        ErrorKind::kBadInput, "%s: header: size %llu x %llu, but %zu bytes cannot hold it; get the whole file again",
        file.c_str(), static_cast<unsigned long long>(width), static_cast<unsigned long long>(height), byteCount);
  }
  return {};
}

Result<Image> readImage(const std::filesystem::path& path, const Image* shape) {
  const std::string file = path.string(), extension = lowerExtension(path);
  const bool isKnown =
      extension == ".pfm" || extension == ".png" || extension == ".jpg" || extension == ".jpeg" || extension == ".f16";
  if (!isKnown) {
    return makeError(ErrorKind::kBadInput, "%s: extension '%s' is no image; give .pfm, .png, .jpg or .f16",
                     file.c_str(), extension.c_str());
  }
  Result<std::vector<uint8_t>> bytes = readFile(path);
  if (!bytes) return bytes.error();
  if (extension == ".pfm") return decodePfm(*bytes, file);
  if (extension == ".png") return decodePng(*bytes, file);
  if (extension == ".f16") return decodeHalves(*bytes, shape, file);
  return decodeJpeg(*bytes, file);
}

Status writeImage(const std::filesystem::path& path, const Image& image) {
  const std::string file = path.string(), extension = lowerExtension(path);
  const uint64_t expected = uint64_t{image.width} * image.height * image.channels;
  if (expected == 0 || (image.channels != 1 && image.channels != 3) || image.values.size() != expected) {
    return makeError(ErrorKind::kUsage, "%s: cannot write an image of %u x %u pixels, %u channels and %zu values",
                     file.c_str(), image.width, image.height, image.channels, image.values.size());
  }
  if (extension == ".pfm") return writeFileAtomically(path, encodePfm(image));
  if (extension != ".png") {
    return makeError(ErrorKind::kUsage, "%s: cannot write '%s'; give a name ending in .pfm or .png", file.c_str(),
                     extension.c_str());
  }
  Result<std::vector<uint8_t>> bytes = encodePng(image, file);
  if (!bytes) return bytes.error();
  return writeFileAtomically(path, *bytes);
}

}  // namespace froth
