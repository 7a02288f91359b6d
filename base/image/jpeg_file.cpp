#include <csetjmp>
#include <cstdio>  // jpeglib.h needs FILE

#include <jpeglib.h>

#include "base/image/formats.h"

namespace froth {
namespace {

// Huffman coding spends at least one bit on each block of 8 x 8 pixels.
constexpr double kMaxPixelsPerByte = 64.0 * 8;

// libjpeg reports errors by longjmp. It lands in readHeader or readRows, whose own frames hold nothing that
// needs a destructor. Warnings (a file cut short, corrupt data) are errors here: an image with a guess in it
// must not be compared.
class JpegDecoder {
 public:
  JpegDecoder() {
    jpeg_.err = jpeg_std_error(&handler_.base);
    handler_.base.error_exit = [](j_common_ptr jpeg) { fail(jpeg); };
    handler_.base.emit_message = [](j_common_ptr jpeg, int level) {
      if (level < 0) fail(jpeg);
    };
    jpeg_create_decompress(&jpeg_);
  }
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;
  ~JpegDecoder() { jpeg_destroy_decompress(&jpeg_); }

  // Afterwards width, height are the file's; nothing is allocated for pixels yet.
  bool readHeader(std::span<const uint8_t> bytes) {
    if (setjmp(handler_.landing)) return false;
    jpeg_mem_src(&jpeg_, bytes.data(), bytes.size());
    jpeg_read_header(&jpeg_, TRUE);
    width = jpeg_.image_width;
    height = jpeg_.image_height;
    jpeg_.out_color_space = jpeg_.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    channels = jpeg_.num_components == 1 ? 1 : 3;
    isFourInks = jpeg_.num_components == 4;
    return true;
  }

  // `pixels` holds height * width * channels bytes.
  bool readRows(uint8_t* pixels) {
    if (setjmp(handler_.landing)) return false;
    jpeg_start_decompress(&jpeg_);
    while (jpeg_.output_scanline < jpeg_.output_height) {
      JSAMPROW row = pixels + size_t{jpeg_.output_scanline} * width * channels;
      jpeg_read_scanlines(&jpeg_, &row, 1);
    }
    jpeg_finish_decompress(&jpeg_);
    return true;
  }

  const char* message() const { return handler_.message; }

  uint32_t width = 0, height = 0, channels = 0;
  bool isFourInks = false;  // CMYK or YCCK, which libjpeg does not convert to RGB

 private:
  struct Handler {
    jpeg_error_mgr base;
    jmp_buf landing;
    char message[JMSG_LENGTH_MAX] = "";
  };

  static void fail(j_common_ptr jpeg) {
    auto* handler = reinterpret_cast<Handler*>(jpeg->err);  // base is its first member
    jpeg->err->format_message(jpeg, handler->message);
    longjmp(handler->landing, 1);
  }

  Handler handler_{};
  jpeg_decompress_struct jpeg_{};
};

Error refuse(const JpegDecoder& decoder, const std::string& file) {
  return makeError(ErrorKind::kBadInput, "%s: JPEG: %s; get the whole file again", file.c_str(), decoder.message());
}

// The decoder's rows: height * width * channels bytes.
Result<std::vector<uint8_t>> decodeRows(JpegDecoder& decoder, std::span<const uint8_t> bytes, const std::string& file) {
  if (!decoder.readHeader(bytes)) return refuse(decoder, file);
  if (Status status = checkImageSize(file, decoder.width, decoder.height, kMaxPixelsPerByte, bytes.size()); !status) {
    return status.error();
  }
  if (decoder.isFourInks) {
    return makeError(ErrorKind::kBadInput, "%s: JPEG: found CMYK colours; convert it to RGB", file.c_str());
  }
  std::vector<uint8_t> pixels(size_t{decoder.width} * decoder.height * decoder.channels);
  if (!decoder.readRows(pixels.data())) return refuse(decoder, file);
  return pixels;
}

}  // namespace

Result<Image> decodeJpeg(std::span<const uint8_t> bytes, const std::string& file) {
  JpegDecoder decoder;
  const Result<std::vector<uint8_t>> pixels = decodeRows(decoder, bytes, file);
  if (!pixels) return pixels.error();
  Image image{decoder.width, decoder.height, decoder.channels, std::vector<float>(pixels->size())};
  for (size_t i = 0; i < pixels->size(); ++i) image.values[i] = static_cast<float>((*pixels)[i]) / 255.0f;
  return image;
}

Result<RgbaImage> decodeRgbaJpeg(std::span<const uint8_t> bytes, const std::string& file) {
  JpegDecoder decoder;
  const Result<std::vector<uint8_t>> pixels = decodeRows(decoder, bytes, file);
  if (!pixels) return pixels.error();
  RgbaImage image{decoder.width, decoder.height, false, {}};
  image.values.resize(size_t{image.width} * image.height * 4, 255);
  const bool isGrey = decoder.channels == 1;
  for (size_t i = 0; i < size_t{image.width} * image.height; ++i) {
    for (size_t c = 0; c < 3; ++c) image.values[4 * i + c] = (*pixels)[isGrey ? i : 3 * i + c];
  }
  return image;
}

Result<ImageSize> jpegSize(std::span<const uint8_t> bytes, const std::string& file) {
  JpegDecoder decoder;
  if (!decoder.readHeader(bytes)) return refuse(decoder, file);
  return ImageSize{decoder.width, decoder.height};
}

}  // namespace froth
