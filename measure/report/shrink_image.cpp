#include "measure/report/shrink_image.h"

namespace froth {

Image shrinkToWidth(const Image& image, uint32_t mostWidth) {
  const uint32_t factor = (image.width + mostWidth - 1) / mostWidth;
  if (factor == 1 || image.height < factor) return image;
  Image small{image.width / factor, image.height / factor, 3, {}};
  for (uint32_t y = 0; y < small.height; ++y) {
    for (size_t i = 0; i < size_t{small.width} * 3; ++i) {
      const auto x = static_cast<uint32_t>(i / 3);
      float sum = 0;
      for (uint32_t part = 0; part < factor * factor; ++part) {
        sum += image.pixel(x * factor + part % factor, y * factor + part / factor)[i % 3];
      }
      small.values.push_back(sum / static_cast<float>(factor * factor));
    }
  }
  return small;
}

}  // namespace froth
