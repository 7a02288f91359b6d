#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/image/formats.h"
#include "measure/report/report.h"
#include "measure/report/shrink_image.h"
#include "reference/image/flip.h"

namespace froth {
namespace {

constexpr uint32_t kCrop = 49, kZoom = 4;               // pixels of the crop's side, and what each becomes
constexpr uint32_t kMapWidth = 640;                     // pixels, most
constexpr uint32_t kGap = 6;                            // between the crops
constexpr float kMarkColour[3] = {0.1f, 0.95f, 0.55f};  // a green that magma does not have

struct Square {
  uint32_t x, y, side;
};

// Around the pixel, moved to lie within the image; smaller where that is.
Square squareAround(const Image& image, uint32_t x, uint32_t y) {
  const uint32_t side = std::min({kCrop, image.width, image.height});
  const auto start = [side](uint32_t centre, uint32_t extent) {
    return std::min(centre - std::min(centre, side / 2), extent - side);
  };
  return {start(x, image.width), start(y, image.height), side};
}

void paint(Image& image, int64_t x, int64_t y) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::copy_n(kMarkColour, 3, image.pixel(uint32_t(x), uint32_t(y)));
}

// A frame just outside [x, x + side), `thickness` pixels wide.
void paintFrame(Image& image, int64_t x, int64_t y, int64_t side, int64_t thickness) {
  for (int64_t t = 1; t <= thickness; ++t) {
    for (int64_t i = -t; i < side + t; ++i) {
      paint(image, x + i, y - t);
      paint(image, x + i, y + side - 1 + t);
      paint(image, x - t, y + i);
      paint(image, x + side - 1 + t, y + i);
    }
  }
}

Image threeChannels(const Image& image) {
  if (image.channels == 3) return image;
  Image wide{image.width, image.height, 3, {}};
  for (float value : image.values) wide.values.insert(wide.values.end(), 3, value);
  return wide;
}

// |a - b| * gain; NaN is white.
Image differenceTimes(const Image& a, const Image& b, float gain) {
  Image difference = a;
  for (size_t i = 0; i < difference.values.size(); ++i) {
    const float value = std::abs(a.values[i] - b.values[i]) * gain;
    difference.values[i] = std::isnan(value) ? 1.0f : value;
  }
  return difference;
}

// A power of two that brings the largest difference in the square to 1/2..1.
float gainFor(const Image& a, const Image& b, const Square& square) {
  float largest = 0;
  for (uint32_t y = square.y; y < square.y + square.side; ++y) {
    for (size_t i = 0; i < size_t{3} * square.side; ++i) {
      largest = std::max(largest, std::abs(a.pixel(square.x, y)[i] - b.pixel(square.x, y)[i]));
    }
  }
  return largest > 0 && largest < 1 ? std::exp2(std::floor(-std::log2(largest))) : 1.0f;
}

void pasteCrop(Image& strip, uint32_t left, const Image& image, const Square& square) {
  for (uint32_t y = 0; y < square.side * kZoom; ++y) {
    for (uint32_t x = 0; x < square.side * kZoom; ++x) {
      std::copy_n(image.pixel(square.x + x / kZoom, square.y + y / kZoom), 3, strip.pixel(left + x, y));
    }
  }
}

Result<ReportImage> makePicture(std::string title, std::string caption, const Image& image) {
  Result<std::vector<uint8_t>> png = encodePng(image, title);
  if (!png) return png.error();
  return ReportImage{std::move(title), std::move(caption), std::move(*png)};
}

}  // namespace

Result<std::vector<ReportImage>> picturesOfError(const std::string& title, const Image& reference, const Image& test,
                                                 uint32_t worstX, uint32_t worstY) {
  if (worstX >= reference.width || worstY >= reference.height) {
    return makeError(ErrorKind::kBadInput, "%s: pixel (%u, %u) lies outside %u x %u", title.c_str(), worstX, worstY,
                     reference.width, reference.height);
  }
  const Result<FlipImage> seenReference = prepareFlip(reference), seenTest = prepareFlip(test);
  if (!seenReference) return seenReference.error();
  if (!seenTest) return seenTest.error();
  const Result<FlipDifference> flip = compareFlip(*seenReference, *seenTest);
  if (!flip) return flip.error();

  const Image a = threeChannels(reference), b = threeChannels(test);
  const Square square = squareAround(a, worstX, worstY);
  Image map = colourErrorMap(flip->map);
  paintFrame(map, square.x, square.y, square.side, 4);
  map = shrinkToWidth(map, kMapWidth);

  const float gain = gainFor(a, b, square);
  const uint32_t side = square.side * kZoom;
  Image strip{3 * side + 2 * kGap, side, 3, {}};
  strip.values.assign(size_t{strip.width} * strip.height * 3, 1.0f);
  const Image crops[] = {a, b, differenceTimes(a, b, gain)};
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t left = i * (side + kGap);
    pasteCrop(strip, left, crops[i], square);
    paintFrame(strip, left + (worstX - square.x) * kZoom, (worstY - square.y) * kZoom, kZoom, 1);
  }

  std::vector<ReportImage> pictures;
  Result<ReportImage> whole = makePicture(
      title,
      fmt::format("FLIP, mean {:.5f}: black is no difference, pale yellow the largest. The frame is the crop.",
                  flip->mean),
      map);
  if (!whole) return whole.error();
  Result<ReportImage> crop = makePicture(
      title + ", worst pixel",
      fmt::format("Around ({}, {}), which is framed: reference, image, difference times {:g}.", worstX, worstY, gain),
      strip);
  if (!crop) return crop.error();
  pictures.push_back(std::move(*whole));
  pictures.push_back(std::move(*crop));
  return pictures;
}

}  // namespace froth
