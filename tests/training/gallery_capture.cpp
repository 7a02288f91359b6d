#include "tests/training/gallery_capture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "baker/synth/synth.h"
#include "foam/detail_colour.h"

namespace froth::test {
namespace {

constexpr uint32_t kPointStride = 4;  // of the sites of the gallery's foam
constexpr uint32_t kSamples = 4;      // per pixel

// On a grid of eyes around that of one of the gallery's views.
std::vector<CapturedView> galleryViews(uint32_t width, uint32_t height) {
  const View middle = resizeView(galleryCameras().views[1], width, height);
  std::vector<CapturedView> captured;
  for (int i = 0; i < 24; ++i) {
    View view = middle;
    view.name = std::string("view_") + char('a' + i);
    const double right = 0.25 * (i % 6 - 2.5), down = 0.2 * (i / 6 - 1.5);
    for (size_t row = 0; row < 12; row += 4) {
      view.worldFromCamera[row + 3] += right * view.worldFromCamera[row] + down * view.worldFromCamera[row + 1];
    }
    captured.push_back({view, {}, {}, {}, {}});
  }
  return captured;
}

std::vector<CapturedPoint> galleryPoints() {
  SynthOptions options;
  options.name = "gallery";
  options.cellCount = 20000;
  options.detailCount = options.lobeCount = 1;
  const Result<Foam> foam = synthesizeFoam(options);
  EXPECT_TRUE(foam) << foam.error().message;
  std::vector<CapturedPoint> points;
  for (uint32_t i = 0; i < foam->cellCount; i += kPointStride) {
    const glm::vec3 colour = glm::clamp(detailColour(*foam, i, {0, 0, 1}), 0.0f, 1.0f) * 255.0f;
    CapturedPoint point;
    point.position = foam->sites[i];
    point.colour = {uint8_t(colour.x), uint8_t(colour.y), uint8_t(colour.z)};
    points.push_back(point);
  }
  return points;
}

Photo tracePhoto(const View& view) {
  const Result<Image> image = traceGallery(view, kSamples);
  EXPECT_TRUE(image) << image.error().message;
  Photo photo;
  photo.view = view;
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        photo.rgba.push_back(static_cast<uint8_t>(std::lround(std::clamp(image->pixel(x, y)[c], 0.0f, 1.0f) * 255)));
      }
      photo.rgba.push_back(255);
    }
  }
  return photo;
}

}  // namespace

GalleryCapture makeGalleryCapture(uint32_t width, uint32_t height, bool hasPoints) {
  GalleryCapture gallery;
  gallery.capture.views = galleryViews(width, height);
  if (hasPoints) gallery.capture.points = galleryPoints();
  std::vector<Photo> photos;
  for (const CapturedView& captured : gallery.capture.views) photos.push_back(tracePhoto(captured.view));
  Result<TrainingSet> set = makeTrainingSet(gallery.capture, std::move(photos), {});
  EXPECT_TRUE(set) << set.error().message;
  gallery.set = std::move(*set);
  return gallery;
}

}  // namespace froth::test
