#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>

#include "base/image/formats.h"

namespace froth {
namespace {

constexpr double kMaxInflation = 1032;  // deflate spends two bits or more on a match, which gives 258 bytes or fewer
constexpr size_t kMaxChunkBytes = size_t{8} << 20;  // of text, profiles and the like

// libpng reports errors by longjmp. It lands in readHeader or readRows, whose own frames hold nothing that
// needs a destructor.
class PngDecoder {
 public:
  explicit PngDecoder(std::span<const uint8_t> bytes) : bytes_(bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &keepMessage, &ignoreWarning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
  }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;
  ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }

  // Afterwards width, height are the file's; nothing is allocated for pixels yet.
  bool readHeader() {
    if (!info_) return false;
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_user_limits(png_, kMaxImageSide, kMaxImageSide);
    png_set_chunk_malloc_max(png_, kMaxChunkBytes);
    png_set_read_fn(png_, this, &readBytes);
    png_read_info(png_, info_);
    width = png_get_image_width(png_, info_);
    height = png_get_image_height(png_, info_);
    bitsPerPixel = png_get_bit_depth(png_, info_) * png_get_channels(png_, info_);
    png_set_expand(png_);  // palettes, 1, 2 and 4 bits, transparent colours
    if (png_get_bit_depth(png_, info_) == 16) png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    channels = png_get_channels(png_, info_);
    bytesPerValue = png_get_bit_depth(png_, info_) / 8;
    rowBytes = png_get_rowbytes(png_, info_);
    return true;
  }

  bool readRows(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  uint32_t width = 0, height = 0, channels = 0, bytesPerValue = 0;
  uint32_t bitsPerPixel = 0;  // in the file; channels, bytesPerValue and rowBytes are those of the decoded rows
  size_t rowBytes = 0;
  char message[160] = "out of memory";

 private:
  [[noreturn]] static void keepMessage(png_structp png, png_const_charp text) {
    auto* self = static_cast<PngDecoder*>(png_get_error_ptr(png));
    std::snprintf(self->message, sizeof self->message, "%s", text);
    png_longjmp(png, 1);
  }
  static void ignoreWarning(png_structp, png_const_charp) {}
  static void readBytes(png_structp png, png_bytep target, size_t count) {
    auto* self = static_cast<PngDecoder*>(png_get_io_ptr(png));
    if (count > self->bytes_.size()) png_error(png, "the file ends too early");
    std::memcpy(target, self->bytes_.data(), count);
    self->bytes_ = self->bytes_.subspan(count);
  }

  std::span<const uint8_t> bytes_;  // not read yet
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

// One file value as 0..1.
float readValue(const uint8_t* row, size_t index, uint32_t bytesPerValue) {
  if (bytesPerValue == 1) return static_cast<float>(row[index]) / 255.0f;
  uint16_t value;
  std::memcpy(&value, row + 2 * index, 2);
  return static_cast<float>(value) / 65535.0f;
}

// The same as 0..255, rounded.
uint8_t readByte(const uint8_t* row, size_t index, uint32_t bytesPerValue) {
  if (bytesPerValue == 1) return row[index];
  uint16_t value;
  std::memcpy(&value, row + 2 * index, 2);
  return static_cast<uint8_t>((value + 128) / 257);
}

Error refuse(const PngDecoder& decoder, const std::string& file) {
  return makeError(ErrorKind::kBadInput, "%s: PNG: %s; get the whole file again", file.c_str(), decoder.message);
}

struct PngRows {
  std::vector<uint8_t> pixels;
  std::vector<png_bytep> rows;  // in `pixels`
};

Result<PngRows> decodeRows(PngDecoder& decoder, std::span<const uint8_t> bytes, const std::string& file) {
  if (!decoder.readHeader()) return refuse(decoder, file);
  const double maxPixelsPerByte = kMaxInflation * 8 / decoder.bitsPerPixel;
  if (Status status = checkImageSize(file, decoder.width, decoder.height, maxPixelsPerByte, bytes.size()); !status) {
    return status.error();
  }
  PngRows decoded{std::vector<uint8_t>(decoder.rowBytes * decoder.height), std::vector<png_bytep>(decoder.height)};
  for (uint32_t y = 0; y < decoder.height; ++y) decoded.rows[y] = &decoded.pixels[y * decoder.rowBytes];
  if (!decoder.readRows(decoded.rows.data())) return refuse(decoder, file);
  return decoded;
}

}  // namespace

Result<Image> decodePng(std::span<const uint8_t> bytes, const std::string& file) {
  PngDecoder decoder(bytes);
  const Result<PngRows> decoded = decodeRows(decoder, bytes, file);
  if (!decoded) return decoded.error();
  const std::vector<png_bytep>& rows = decoded->rows;

  const bool hasAlpha = decoder.channels % 2 == 0;
  Image image{decoder.width, decoder.height, decoder.channels - hasAlpha, {}};
  image.values.reserve(size_t{image.width} * image.height * image.channels);
  for (uint32_t y = 0; y < image.height; ++y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      const size_t first = size_t{x} * decoder.channels;
      // Images of Froth are premultiplied over black.
      const float alpha = hasAlpha ? readValue(rows[y], first + image.channels, decoder.bytesPerValue) : 1.0f;
      for (uint32_t c = 0; c < image.channels; ++c) {
        image.values.push_back(alpha * readValue(rows[y], first + c, decoder.bytesPerValue));
      }
    }
  }
  return image;
}

Result<RgbaImage> decodeRgbaPng(std::span<const uint8_t> bytes, const std::string& file) {
  PngDecoder decoder(bytes);
  const Result<PngRows> decoded = decodeRows(decoder, bytes, file);
  if (!decoded) return decoded.error();
  const bool hasAlpha = decoder.channels % 2 == 0;
  const uint32_t colours = decoder.channels - hasAlpha;
  RgbaImage image{decoder.width, decoder.height, hasAlpha, {}};
  image.values.reserve(size_t{image.width} * image.height * 4);
  for (uint32_t y = 0; y < image.height; ++y) {
    const uint8_t* row = decoded->rows[y];
    for (uint32_t x = 0; x < image.width; ++x) {
      const size_t first = size_t{x} * decoder.channels;
      for (uint32_t c = 0; c < 3; ++c) {
        image.values.push_back(readByte(row, first + (colours == 1 ? 0 : c), decoder.bytesPerValue));
      }
      image.values.push_back(hasAlpha ? readByte(row, first + colours, decoder.bytesPerValue) : uint8_t{255});
    }
  }
  return image;
}

Result<ImageSize> pngSize(std::span<const uint8_t> bytes, const std::string& file) {
  PngDecoder decoder(bytes);
  if (!decoder.readHeader()) return refuse(decoder, file);
  return ImageSize{decoder.width, decoder.height};
}

Result<std::vector<uint8_t>> encodePng(const Image& image, const std::string& file) {
  std::vector<uint8_t> pixels(image.values.size());
  for (size_t i = 0; i < pixels.size(); ++i) {
    const float value = image.values[i] > 0 ? std::min(image.values[i], 1.0f) : 0.0f;  // NaN becomes 0
    pixels[i] = static_cast<uint8_t>(value * 255.0f + 0.5f);
  }
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = image.width;
  png.height = image.height;
  png.format = image.channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY;
  png_alloc_size_t byteCount = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<uint8_t> bytes(byteCount);
  if (!png_image_write_to_memory(&png, bytes.data(), &byteCount, 0, pixels.data(), 0, nullptr)) {
    return makeError(ErrorKind::kIo, "%s: PNG: %s", file.c_str(), png.message);
  }
  bytes.resize(byteCount);
  return bytes;
}

}  // namespace froth
