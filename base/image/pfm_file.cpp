// Portable float map: "PF" or "Pf", width, height, scale (negative: little-endian), one white space, then
// rows from the bottom up.
#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>

#include "base/image/formats.h"

namespace froth {
namespace {

constexpr size_t kMaxHeaderBytes = 128;

struct PfmHeader {
  std::string magic;
  uint64_t width = 0, height = 0;
  double scale = 0;
  size_t byteCount = 0;
};

Result<PfmHeader> readHeader(std::span<const uint8_t> bytes, const std::string& file) {
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  std::istringstream stream(std::string(text, std::min(bytes.size(), kMaxHeaderBytes)));
  PfmHeader header;
  stream >> header.magic >> header.width >> header.height >> header.scale;
  const bool isWhole = stream && std::isspace(stream.get());
  if (!isWhole || (header.magic != "PF" && header.magic != "Pf") || !std::isfinite(header.scale) || header.scale == 0) {
    return makeError(ErrorKind::kBadInput, "%s: header: not a PFM; it starts 'PF' or 'Pf', width, height, scale",
                     file.c_str());
  }
  header.byteCount = static_cast<size_t>(stream.tellg());
  return header;
}

}  // namespace

Result<Image> decodePfm(std::span<const uint8_t> bytes, const std::string& file) {
  Result<PfmHeader> header = readHeader(bytes, file);
  if (!header) return header.error();
  const uint32_t channels = header->magic == "PF" ? 3 : 1;
  if (Status status = checkImageSize(file, header->width, header->height, 1.0 / (4 * channels), bytes.size());
      !status) {
    return status.error();
  }
  const size_t rowValues = header->width * channels;
  const size_t expected = header->byteCount + rowValues * header->height * 4;
  if (bytes.size() != expected) {
    return makeError(ErrorKind::kBadInput, "%s: found %zu bytes instead of %zu; get the whole file again", file.c_str(),
                     bytes.size(), expected);
  }
  Image image{static_cast<uint32_t>(header->width), static_cast<uint32_t>(header->height), channels,
              std::vector<float>(rowValues * header->height)};
  const bool isSwapped = (header->scale < 0) != (std::endian::native == std::endian::little);
  for (uint32_t y = 0; y < image.height; ++y) {
    const uint8_t* row = bytes.data() + header->byteCount + (image.height - 1 - y) * rowValues * 4;
    for (size_t i = 0; i < rowValues; ++i) {
      uint32_t bits;
      std::memcpy(&bits, row + 4 * i, 4);
      image.values[y * rowValues + i] = std::bit_cast<float>(isSwapped ? __builtin_bswap32(bits) : bits);
    }
  }
  return image;
}

std::vector<uint8_t> encodePfm(const Image& image) {
  static_assert(std::endian::native == std::endian::little, "the header written below says little-endian");
  const std::string header = std::string(image.channels == 3 ? "PF\n" : "Pf\n") + std::to_string(image.width) + " " +
                             std::to_string(image.height) + "\n-1.0\n";
  const size_t rowBytes = size_t{image.width} * image.channels * 4;
  std::vector<uint8_t> bytes(header.size() + rowBytes * image.height);
  std::memcpy(bytes.data(), header.data(), header.size());
  for (uint32_t row = 0; row < image.height; ++row) {
    std::memcpy(&bytes[header.size() + row * rowBytes], image.pixel(0, image.height - 1 - row), rowBytes);
  }
  return bytes;
}

}  // namespace froth
