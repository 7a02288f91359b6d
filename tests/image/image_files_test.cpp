#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include <jpeglib.h>
#include <png.h>
#include <zlib.h>

#include "base/image/image.h"

namespace froth {
namespace {

using ::testing::HasSubstr;
using Bytes = std::vector<uint8_t>;

class ImageFilesTest : public ::testing::Test {
 protected:
  ImageFilesTest() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) / (std::string("froth_") + test->name());
    std::filesystem::create_directories(folder_);
  }
  ~ImageFilesTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const Bytes& bytes) {
    const std::filesystem::path path = folder_ / name;
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    return path;
  }
  std::filesystem::path write(const std::string& name, const std::string& text) {
    return write(name, Bytes(text.begin(), text.end()));
  }
  static Bytes load(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  void expectBad(const std::filesystem::path& path, const char* part = "") {
    const Result<Image> image = readImage(path);
    ASSERT_FALSE(image) << path;
    EXPECT_EQ(image.error().kind, ErrorKind::kBadInput);
    EXPECT_THAT(image.error().message, HasSubstr(path.filename().string()));
    EXPECT_THAT(image.error().message, HasSubstr(part));
  }

  std::filesystem::path folder_;
};

Image ramp(uint32_t width, uint32_t height, uint32_t channels) {
  Image image{width, height, channels, {}};
  for (size_t i = 0; i < size_t{width} * height * channels; ++i) image.values.push_back(float(i * 7 % 256) / 255.0f);
  return image;
}

Bytes encodeJpeg(const Image& image, bool isProgressive) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &memory, &size);
  jpeg.image_width = image.width;
  jpeg.image_height = image.height;
  jpeg.input_components = int(image.channels);
  jpeg.in_color_space = image.channels == 3 ? JCS_RGB : JCS_GRAYSCALE;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  if (isProgressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  for (uint32_t y = 0; y < image.height; ++y) {
    Bytes row;
    for (uint32_t i = 0; i < image.width * image.channels; ++i) {
      row.push_back(uint8_t(image.pixel(0, y)[i] * 255 + 0.5f));
    }
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&jpeg, &pointer, 1);
  }
  jpeg_finish_compress(&jpeg);
  Bytes bytes(memory, memory + size);
  jpeg_destroy_compress(&jpeg);
  free(memory);
  return bytes;
}

// A PNG of any colour type through libpng's own writer; `rows` are file bytes.
void encodePng(const std::filesystem::path& path, uint32_t width, uint32_t height, int depth, int type,
               const Bytes& pixels) {
  FILE* file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, width, height, depth, type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  const png_color palette[2] = {{255, 0, 0}, {0, 0, 255}};
  if (type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 2);
  png_write_info(png, info);
  const size_t rowBytes = pixels.size() / height;
  for (uint32_t y = 0; y < height; ++y) png_write_row(png, &pixels[y * rowBytes]);
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

TEST_F(ImageFilesTest, PfmKeepsEveryFloat) {
  for (uint32_t channels : {1u, 3u}) {
    Image image = ramp(5, 3, channels);
    image.values[1] = -1.0f;
    image.values[2] = std::numeric_limits<float>::infinity();
    image.values[3] = 1e-42f;
    ASSERT_TRUE(writeImage(folder_ / "a.pfm", image));
    const Result<Image> read = readImage(folder_ / "a.pfm");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->width, 5u);
    EXPECT_EQ(read->height, 3u);
    EXPECT_EQ(read->channels, channels);
    EXPECT_EQ(std::memcmp(read->values.data(), image.values.data(), image.values.size() * 4), 0);
  }
}

TEST_F(ImageFilesTest, PfmRowsRunFromTheBottomUpAndBigEndianIsRead) {
  // Two rows of one value: 1.0 is the lower row, and comes first in the file.
  const Bytes big = {'P', 'f', '\n', '1', ' ', '2', '\n', '1', '.', '0', '\n', 0x3f, 0x80, 0, 0, 0x40, 0, 0, 0};
  const Result<Image> image = readImage(write("big.pfm", big));
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->values, (std::vector<float>{2.0f, 1.0f}));
}

TEST_F(ImageFilesTest, BrokenPfmIsRefused) {
  expectBad(write("a.pfm", std::string()), "PFM");
  expectBad(write("b.pfm", std::string("P6\n1 1\n-1\nabcd")), "PFM");
  expectBad(write("c.pfm", std::string("Pf\n-1 1\n-1\nabcd")));
  expectBad(write("d.pfm", std::string("Pf\n0 1\n-1\nabcd")), "0 x 1");
  expectBad(write("e.pfm", std::string("PF\n60000 4000\n-1\nabcd")), "60000");
  expectBad(write("f.pfm", std::string("PF\n4294967296 4294967296\n-1\nabcd")), "4294967296");
  expectBad(write("g.pfm", std::string("PF\n99999999999999999999999 1\n-1\nabcd")));
  expectBad(write("h.pfm", std::string("Pf\n1 1\nnan\nabcd")), "PFM");
  expectBad(write("i.pfm", std::string("Pf\n1 1\n-1\nabc")), "13 bytes instead of 14");
  expectBad(write("j.pfm", std::string("Pf\n1 1\n-1\nabcde")), "bytes instead of");
}

TEST_F(ImageFilesTest, PngClampsRoundsAndComesBackWithinHalfAStep) {
  Image image = ramp(16, 9, 3);
  image.values[0] = -0.5f;
  image.values[1] = 7.0f;
  image.values[2] = std::nanf("");
  image.values[3] = 0.5f;
  ASSERT_TRUE(writeImage(folder_ / "a.png", image));
  const Result<Image> read = readImage(folder_ / "a.png");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->channels, 3u);
  EXPECT_EQ(read->values[0], 0.0f);
  EXPECT_EQ(read->values[1], 1.0f);
  EXPECT_EQ(read->values[2], 0.0f);
  EXPECT_EQ(read->values[3], 128.0f / 255.0f);
  for (size_t i = 4; i < image.values.size(); ++i) EXPECT_EQ(read->values[i], image.values[i]);

  ASSERT_TRUE(writeImage(folder_ / "grey.PNG", ramp(3, 2, 1)));
  EXPECT_EQ(readImage(folder_ / "grey.PNG")->values, ramp(3, 2, 1).values);
}

TEST_F(ImageFilesTest, EveryKindOfPngIsRead) {
  encodePng(folder_ / "grey16.png", 2, 1, 16, PNG_COLOR_TYPE_GRAY, {0x80, 0x01, 0xff, 0xff});
  EXPECT_EQ(readImage(folder_ / "grey16.png")->values, (std::vector<float>{float(0x8001) / 65535.0f, 1.0f}));
  encodePng(folder_ / "bits.png", 3, 1, 1, PNG_COLOR_TYPE_GRAY, {0xa0});
  EXPECT_EQ(readImage(folder_ / "bits.png")->values, (std::vector<float>{1, 0, 1}));
  encodePng(folder_ / "palette.png", 2, 1, 8, PNG_COLOR_TYPE_PALETTE, {0, 1});
  EXPECT_EQ(readImage(folder_ / "palette.png")->values, (std::vector<float>{1, 0, 0, 0, 0, 1}));
  // Transparent white is black, as everything lies over black.
  encodePng(folder_ / "rgba.png", 2, 1, 8, PNG_COLOR_TYPE_RGB_ALPHA, {255, 255, 255, 0, 255, 0, 0, 255});
  EXPECT_EQ(readImage(folder_ / "rgba.png")->values, (std::vector<float>{0, 0, 0, 1, 0, 0}));
}

TEST_F(ImageFilesTest, PngCutAtAnyLengthIsRefused) {
  ASSERT_TRUE(writeImage(folder_ / "a.png", ramp(20, 10, 3)));
  const Bytes whole = load(folder_ / "a.png");
  // The last 12 bytes are the IEND chunk's.
  for (size_t length = 0; length < whole.size(); ++length) {
    EXPECT_FALSE(readImage(write("cut.png", Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(length))))) << length;
  }
}

TEST_F(ImageFilesTest, PngOfAHugeDeclaredSizeIsRefusedBeforeMemoryIsTaken) {
  Bytes pixels(16);
  encodePng(folder_ / "a.png", 16, 1, 8, PNG_COLOR_TYPE_GRAY, pixels);
  Bytes bytes = load(folder_ / "a.png");
  bytes[18] = 0x40;  // IHDR width: 16 -> 16400
  bytes[22] = 0x40;  // height: 1 -> 16385
  const uLong crc = crc32(0, &bytes[12], 17);
  for (int i = 0; i < 4; ++i) bytes[29 + i] = uint8_t(crc >> (24 - 8 * i));
  expectBad(write("huge.png", bytes), "16400 x 16385");
}

TEST_F(ImageFilesTest, JpegIsReadBaselineAndProgressive) {
  for (uint32_t channels : {1u, 3u}) {
    Image image{24, 17, channels, {}};
    for (uint32_t y = 0; y < 17; ++y) {
      for (uint32_t x = 0; x < 24 * channels; ++x) image.values.push_back(float(x / channels + y) / 60.0f);
    }
    for (bool isProgressive : {false, true}) {
      const Result<Image> read = readImage(write("a.jpg", encodeJpeg(image, isProgressive)));
      ASSERT_TRUE(read) << read.error().message;
      ASSERT_EQ(read->values.size(), image.values.size());
      for (size_t i = 0; i < image.values.size(); ++i) ASSERT_NEAR(read->values[i], image.values[i], 0.02) << i;
    }
  }
}

TEST_F(ImageFilesTest, JpegCutAtAnyLengthIsRefusedAndNoFlippedByteCrashes) {
  const Bytes whole = encodeJpeg(ramp(16, 16, 1), false);
  for (size_t length = 0; length + 2 < whole.size(); length += 7) {
    EXPECT_FALSE(readImage(write("cut.jpg", Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(length))))) << length;
  }
  for (size_t i = 0; i < whole.size(); i += 3) {
    Bytes flipped = whole;
    flipped[i] ^= 0x5a;
    (void)readImage(write("flipped.jpg", flipped));
  }
}

TEST_F(ImageFilesTest, HalvesTakeTheSizeOfAnotherImageAndTheirChannelsFromTheLength) {
  // 1.0, -1.0, 0.5, 2^-24, 65504, 0
  const std::filesystem::path path =
      write("a.f16", Bytes{0x00, 0x3c, 0x00, 0xbc, 0x00, 0x38, 0x01, 0x00, 0xff, 0x7b, 0x00, 0x00});
  const Image two{2, 1, 1, {0, 0}};
  const Result<Image> colour = readImage(path, &two);
  ASSERT_TRUE(colour) << colour.error().message;
  EXPECT_EQ(colour->channels, 3u);
  EXPECT_EQ(colour->values, (std::vector<float>{1.0f, -1.0f, 0.5f, std::ldexp(1.0f, -24), 65504.0f, 0.0f}));
  const Image six{3, 2, 1, std::vector<float>(6)};
  EXPECT_EQ(readImage(path, &six)->channels, 1u);
  const Image five{5, 1, 1, std::vector<float>(5)};
  EXPECT_FALSE(readImage(path, &five));
  const Result<Image> unknown = readImage(path);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::kUsage);
}

TEST_F(ImageFilesTest, OtherNamesAreRefused) {
  expectBad(write("a.bmp", std::string("BM")), ".bmp");
  expectBad(folder_ / "absent.png");
  const Status status = writeImage(folder_ / "a.jpg", ramp(2, 2, 3));
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().kind, ErrorKind::kUsage);
  EXPECT_FALSE(writeImage(folder_ / "a.png", Image{2, 2, 3, {0}}));
  EXPECT_FALSE(writeImage(folder_ / "no such folder" / "a.png", ramp(2, 2, 3)));
}

}  // namespace
}  // namespace froth
