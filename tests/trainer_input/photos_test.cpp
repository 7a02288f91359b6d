// Photos and masks of many kinds, as training keeps them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include <jpeglib.h>
#include <png.h>

#include "trainer/photos/box_filter.h"
#include "trainer/photos/photos.h"

namespace froth {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using Bytes = std::vector<uint8_t>;

// `pixels`: rows of a PNG file of that depth and colour type.
void writePng(const fs::path& path, uint32_t width, uint32_t height, int depth, int type, const Bytes& pixels) {
  FILE* file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, width, height, depth, type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (uint32_t y = 0; y < height; ++y) png_write_row(png, &pixels[y * (pixels.size() / height)]);
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

// All of one value; `orientation` 0: without EXIF.
void writeJpeg(const fs::path& path, uint32_t width, uint32_t height, int channels, int orientation = 0) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  FILE* file = std::fopen(path.c_str(), "wb");
  jpeg_stdio_dest(&jpeg, file);
  jpeg.image_width = width;
  jpeg.image_height = height;
  jpeg.input_components = channels;
  jpeg.in_color_space = channels == 1 ? JCS_GRAYSCALE : channels == 3 ? JCS_RGB : JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  if (orientation > 0) {
    const Bytes exif = {'E', 'x', 'i', 'f',  0,    0, 'M', 'M', 0, 42, 0, 0, 0,
                        8,   0,   1,   0x01, 0x12, 0, 3,   0,   0, 0,  1, 0, uint8_t(orientation),
                        0,   0,   0,   0,    0,    0};
    jpeg_write_marker(&jpeg, JPEG_APP0 + 1, exif.data(), unsigned(exif.size()));
  }
  Bytes row(size_t{width} * channels, 90);
  JSAMPROW pointer = row.data();
  for (uint32_t y = 0; y < height; ++y) jpeg_write_scanlines(&jpeg, &pointer, 1);
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  std::fclose(file);
}

class PhotosTest : public ::testing::Test {
 protected:
  PhotosTest() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("froth_photos_") + test->name());
    fs::create_directories(folder_);
  }
  ~PhotosTest() override { fs::remove_all(folder_); }

  CapturedView view(const std::string& name, uint32_t width, uint32_t height, const std::string& mask = "") {
    CapturedView view;
    view.view.name = name;
    view.view.width = width;
    view.view.height = height;
    view.view.fx = view.view.fy = 10;
    view.view.cx = 0.5 * width;
    view.view.cy = 0.25 * height;
    view.photo = folder_ / name;
    if (!mask.empty()) view.mask = folder_ / mask;
    return view;
  }

  Photo readOne(const CapturedView& view, const PhotoOptions& options = {}) {
    Result<std::vector<Photo>> photos = readPhotos({view}, options);
    if (photos) return std::move(photos->front());
    ADD_FAILURE() << photos.error().message;
    return {};
  }

  void expectBad(const CapturedView& view, const std::vector<std::string>& parts) {
    const Result<std::vector<Photo>> photos = readPhotos({view}, {});
    ASSERT_FALSE(photos) << parts[0];
    for (const std::string& part : parts) EXPECT_THAT(photos.error().message, HasSubstr(part));
  }

  fs::path folder_;
};

TEST_F(PhotosTest, GreySixteenBitsAndAlphaBecomeEightBitsPremultiplied) {
  writePng(folder_ / "grey.png", 2, 1, 8, PNG_COLOR_TYPE_GRAY, {10, 200});
  EXPECT_THAT(readOne(view("grey.png", 2, 1)).rgba, ElementsAre(10, 10, 10, 255, 200, 200, 200, 255));
  writePng(folder_ / "deep.png", 1, 1, 16, PNG_COLOR_TYPE_RGB, {0x80, 0x00, 0xff, 0xff, 0x00, 0x81});
  EXPECT_THAT(readOne(view("deep.png", 1, 1)).rgba, ElementsAre(128, 255, 1, 255));
  writePng(folder_ / "clear.png", 1, 1, 8, PNG_COLOR_TYPE_RGB_ALPHA, {200, 100, 255, 51});
  EXPECT_THAT(readOne(view("clear.png", 1, 1)).rgba, ElementsAre(40, 20, 51, 51));
  PhotoOptions options;
  options.alpha = AlphaForm::kPremultiplied;
  EXPECT_THAT(readOne(view("clear.png", 1, 1), options).rgba, ElementsAre(51, 51, 51, 51));  // not above white
  writeJpeg(folder_ / "grey.jpg", 8, 8, 1);
  const Photo grey = readOne(view("grey.jpg", 8, 8));
  for (size_t i = 0; i < grey.rgba.size(); ++i) ASSERT_NEAR(grey.rgba[i], i % 4 == 3 ? 255 : 90, 1);
}

TEST_F(PhotosTest, MasksIgnoreOrCutOut) {
  writePng(folder_ / "a.png", 2, 1, 8, PNG_COLOR_TYPE_RGB, {200, 100, 50, 200, 100, 50});
  writePng(folder_ / "m.png", 2, 1, 8, PNG_COLOR_TYPE_GRAY, {0, 255});
  CapturedView masked = view("a.png", 2, 1, "m.png");
  Photo photo = readOne(masked);
  EXPECT_THAT(photo.counted, ElementsAre(0, 1));
  EXPECT_EQ(photo.rgba[0], 200);
  masked.maskSense = MaskSense::kWhiteIgnored;
  EXPECT_THAT(readOne(masked).counted, ElementsAre(1, 0));
  PhotoOptions options;
  options.isMaskAlpha = true;
  photo = readOne(masked, options);
  EXPECT_TRUE(photo.counted.empty());
  EXPECT_THAT(photo.rgba, ElementsAre(200, 100, 50, 255, 0, 0, 0, 0));
  EXPECT_TRUE(readOne(view("a.png", 2, 1)).counted.empty());
}

TEST_F(PhotosTest, ReductionAveragesWhatIsPremultiplied) {
  // A red pixel, and three that are clear: their colour must not show.
  const Bytes pixels = {255, 0, 0, 255, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0};
  writePng(folder_ / "a.png", 2, 2, 8, PNG_COLOR_TYPE_RGB_ALPHA, pixels);
  PhotoOptions options;
  options.downscale = 2;
  const Photo photo = readOne(view("a.png", 2, 2), options);
  EXPECT_THAT(photo.rgba, ElementsAre(64, 0, 0, 64));
  EXPECT_EQ(photo.view.width, 1u);
  EXPECT_EQ(photo.view.fx, 5);
  EXPECT_EQ(photo.view.cy, 0.25);
}

TEST_F(PhotosTest, ReductionByPartsOfPixelsIsExact) {
  // 3 pixels to 2: each new one is a whole and a half old one.
  const Bytes row = {0, 30, 60, 255, 90, 30, 0, 255, 30, 60, 0, 255};
  EXPECT_THAT(reducePixels(row, 3, 1, 2, 1), ElementsAre(30, 30, 40, 255, 50, 50, 0, 255));
  EXPECT_THAT(reduceFlags({1, 1, 0}, 3, 1, 2, 1), ElementsAre(1, 0));
  EXPECT_THAT(reduceFlags({1, 0, 1}, 3, 1, 2, 1), ElementsAre(0, 0));
  EXPECT_EQ(reducedSide(1319, 4), 330u);
  EXPECT_EQ(reducedSide(1, 8), 1u);
  // A reduced constant stays the same at odd sizes.
  EXPECT_THAT(reducePixels(Bytes(size_t{4} * 17 * 11, 77), 17, 11, 6, 4), ::testing::Each(77));
}

TEST_F(PhotosTest, PhotosOfTwoSizesAndTheirIntrinsicsScaleExactly) {
  writeJpeg(folder_ / "a.jpg", 101, 51, 3);
  writeJpeg(folder_ / "b.jpg", 40, 64, 3);
  PhotoOptions options;
  options.downscale = 4;
  const Result<std::vector<Photo>> photos = readPhotos({view("a.jpg", 101, 51), view("b.jpg", 40, 64)}, options);
  ASSERT_TRUE(photos) << photos.error().message;
  const View& first = (*photos)[0].view;
  EXPECT_EQ(first.width, 25u);
  EXPECT_EQ(first.height, 13u);
  EXPECT_DOUBLE_EQ(first.fx, 10 * 25.0 / 101);
  EXPECT_DOUBLE_EQ(first.fy, 10 * 13.0 / 51);
  EXPECT_DOUBLE_EQ(first.cy, 0.25 * 13);
  EXPECT_EQ((*photos)[1].view.height, 16u);
  EXPECT_EQ((*photos)[1].rgba.size(), size_t{4} * 10 * 16);
}

TEST_F(PhotosTest, FaultsAreNamed) {
  expectBad(view("absent.jpg", 8, 8), {"absent.jpg", "no such photo, as 1 of 1"});
  writeJpeg(folder_ / "inks.jpg", 8, 8, 4);
  expectBad(view("inks.jpg", 8, 8), {"inks.jpg", "CMYK", "convert it to RGB"});
  writeJpeg(folder_ / "small.jpg", 16, 8, 3);
  expectBad(view("small.jpg", 32, 16), {"small.jpg", "found 16 x 8 pixels, its camera has 32 x 16", "--downscale"});
  writeJpeg(folder_ / "turned.jpg", 16, 8, 3, 6);
  expectBad(view("turned.jpg", 8, 16), {"turned.jpg", "EXIF turns it", "auto-orient"});
  EXPECT_EQ(readOne(view("turned.jpg", 16, 8)).view.width, 16u);  // COLMAP calibrates photos as they are stored
  std::ofstream(folder_ / "lfs.jpg") << "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n";
  expectBad(view("lfs.jpg", 8, 8), {"lfs.jpg", "pointer of Git LFS", "git lfs pull"});
  std::ofstream(folder_ / "empty.png");
  expectBad(view("empty.png", 8, 8), {"empty.png", "an empty file"});
  std::ofstream(folder_ / "text.png") << "no image";
  expectBad(view("text.png", 8, 8), {"text.png", "neither a JPEG nor a PNG header"});
  std::ifstream whole(folder_ / "small.jpg", std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(whole), {});
  std::ofstream(folder_ / "cut.jpg", std::ios::binary) << bytes.substr(0, bytes.size() - 20);
  expectBad(view("cut.jpg", 16, 8), {"cut.jpg", "get the whole file again"});
  writePng(folder_ / "m.png", 2, 1, 8, PNG_COLOR_TYPE_GRAY, {0, 255});
  expectBad(view("small.jpg", 16, 8, "m.png"), {"m.png", "found 2 x 1 pixels, its photo", "16 x 8"});
}

TEST_F(PhotosTest, TheFirstFaultyViewIsNamedAndMemoryIsBounded) {
  writeJpeg(folder_ / "a.jpg", 16, 8, 3);
  writeJpeg(folder_ / "b.jpg", 8, 8, 3);
  std::vector<CapturedView> views(20, view("a.jpg", 16, 8));
  views[7] = view("b.jpg", 9, 9);
  views[15] = view("b.jpg", 7, 7);
  const Result<std::vector<Photo>> faulty = readPhotos(views, {});
  ASSERT_FALSE(faulty);
  EXPECT_THAT(faulty.error().message, HasSubstr("9 x 9"));
  PhotoOptions options;
  options.mostBytes = 16 * 8 * 4 * 20 - 1;
  views = std::vector<CapturedView>(20, view("a.jpg", 16, 8));
  const Result<std::vector<Photo>> large = readPhotos(views, options);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().kind, ErrorKind::kMemory);
  options.downscale = 2;
  EXPECT_TRUE(readPhotos(views, options));
  const Result<std::vector<Photo>> stopped = readPhotos(views, {}, [](auto, auto, auto) { return false; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace froth
