#include "tool/photo_image.h"

#include <algorithm>

namespace froth {
namespace {

template <class ColourAt>
Image countedPixels(const Photo& photo, ColourAt&& colourAt) {
  const size_t pixelCount = photo.rgba.size() / 4;
  Image image{photo.view.width, photo.view.height, 3, std::vector<float>(3 * pixelCount)};
  for (size_t i = 0; i < pixelCount; ++i) {
    if (!photo.counted.empty() && !photo.counted[i]) continue;
    for (size_t c = 0; c < 3; ++c) image.values[3 * i + c] = colourAt(i, c);
  }
  return image;
}

}  // namespace

Image imageOf(const Photo& photo) {
  return countedPixels(photo, [&](size_t i, size_t c) { return static_cast<float>(photo.rgba[4 * i + c]) / 255; });
}

Image imageOf(const Photo& photo, const std::vector<glm::vec4>& shown) {
  return countedPixels(photo, [&](size_t i, size_t c) { return shown[i][static_cast<int>(c)]; });
}

}  // namespace froth
