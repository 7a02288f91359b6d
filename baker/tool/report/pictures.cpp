#include "baker/tool/report/pictures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "baker/image/flip.h"
#include "baker/image/formats.h"

namespace froth {
namespace {

constexpr uint32_t kWidth = 360;      // [pixels] of an image, most
constexpr uint32_t kCrop = 48;        // [pixels] around a worst pixel
constexpr uint32_t kMagnified = 4;
constexpr float kDifferenceGain = 8;

// Mean of the pixels that fall onto each.
Image shrinkTo(const Image& image, uint32_t width) {
  if (image.width <= width) return image;
  const uint32_t height = std::max(1u, image.height * width / image.width);
  Image small{width, height, 3, std::vector<float>(size_t{width} * height * 3)};
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const uint32_t x0 = x * image.width / width, x1 = std::max(x0 + 1, (x + 1) * image.width / width);
      const uint32_t y0 = y * image.height / height, y1 = std::max(y0 + 1, (y + 1) * image.height / height);
      for (uint32_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (uint32_t v = y0; v < y1; ++v) {
          for (uint32_t u = x0; u < x1; ++u) sum += std::clamp(image.pixel(u, v)[c], 0.0f, 1.0f);
        }
        small.pixel(x, y)[c] = static_cast<float>(sum / (x1 - x0) / (y1 - y0));
      }
    }
  }
  return small;
}

// Side by side, all of one height.
Image joinRow(const std::vector<Image>& images) {
  Image row{0, images[0].height, 3, {}};
  for (const Image& image : images) row.width += image.width;
  for (uint32_t y = 0; y < row.height; ++y) {
    for (const Image& image : images) row.values.insert(row.values.end(), image.pixel(0, y), image.pixel(0, y) + size_t{image.width} * 3);
  }
  return row;
}

// Pixels made large; `colourAt(x, y, channel)` of the crop around a pixel, moved inside the image.
template <class ColourAt>
Image magnify(const Image& image, uint32_t centreX, uint32_t centreY, const ColourAt& colourAt) {
  const uint32_t width = std::min(kCrop, image.width), height = std::min(kCrop, image.height);
  const auto origin = [](uint32_t centre, uint32_t size, uint32_t all) {
    return std::min(centre > size / 2 ? centre - size / 2 : 0, all - size);
  };
  const uint32_t x0 = origin(centreX, width, image.width), y0 = origin(centreY, height, image.height);
  Image large{width * kMagnified, height * kMagnified, 3, {}};
  for (uint32_t y = 0; y < large.height; ++y) {
    for (uint32_t x = 0; x < large.width; ++x) {
      for (uint32_t c = 0; c < 3; ++c) large.values.push_back(colourAt(x0 + x / kMagnified, y0 + y / kMagnified, c));
    }
  }
  return large;
}

Status addPicture(std::string title, std::string caption, const Image& image, std::vector<ReportImage>& pictures) {
  Result<std::vector<uint8_t>> png = encodePng(image, "report");
  if (!png) return png.error();
  pictures.push_back({std::move(title), std::move(caption), std::move(*png)});
  return {};
}

Status addView(const ViewErrors& errors, const Image& exact, const Image& drawn, std::vector<ReportImage>& pictures) {
  const Result<FlipImage> exactFlip = prepareFlip(exact), drawnFlip = prepareFlip(drawn);
  if (!exactFlip) return exactFlip.error();
  if (!drawnFlip) return drawnFlip.error();
  const Result<FlipDifference> flip = compareFlip(*exactFlip, *drawnFlip);
  if (!flip) return flip.error();
  const Image map = colourErrorMap(flip->map);
  if (Status added = addPicture(fmt::format("view {}", errors.view),
                                fmt::format("drawn, and FLIP: {:.2f} dB, mean FLIP {:.4f}", errors.errors.psnr, flip->mean),
                                joinRow({shrinkTo(drawn, kWidth), shrinkTo(map, kWidth)}), pictures);
      !added)
    return added;
  const auto crop = [&](const auto& colourAt) { return magnify(exact, errors.worstX, errors.worstY, colourAt); };
  const Image around = joinRow(
      {crop([&](uint32_t x, uint32_t y, uint32_t c) { return exact.pixel(x, y)[c]; }),
       crop([&](uint32_t x, uint32_t y, uint32_t c) { return drawn.pixel(x, y)[c]; }),
       crop([&](uint32_t x, uint32_t y, uint32_t c) { return kDifferenceGain * std::abs(exact.pixel(x, y)[c] - drawn.pixel(x, y)[c]); })});
  return addPicture(fmt::format("view {}, around its worst pixel ({}, {})", errors.view, errors.worstX, errors.worstY),
                    fmt::format("exact, drawn, {} times their difference; off by {:.3f} at most", kDifferenceGain, errors.errors.maxError),
                    around, pictures);
}

}  // namespace

Result<std::vector<ReportImage>> drawPictures(const Bench& bench, const PlannedPoint& planned) {
  const Result<std::vector<RenderedImages>> images = bench.drawer.render(drawOf(bench, planned.config), {});
  if (!images) return images.error();
  std::vector<ReportImage> pictures;
  for (size_t i = 0; i < images->size(); ++i) {
    if (Status added = addView(planned.point.views[i], bench.truth.exact(i), (*images)[i].colour, pictures); !added)
      return added.error();
  }
  return pictures;
}

}  // namespace froth
