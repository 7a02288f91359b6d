// Channels of images as they are read back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <vulkan/vulkan.h>

#include "base/image/image.h"

namespace froth {

// `channels` values of each texel, from its value `first` on; a texel has `stride`.
inline Image imageFromTexels(const std::vector<float>& texels, uint32_t stride, uint32_t first, uint32_t channels,
                             VkExtent2D extent) {
  Image image{extent.width, extent.height, channels, {}};
  const size_t count = size_t{extent.width} * extent.height;
  image.values.reserve(count * channels);
  for (size_t pixel = 0; pixel < count; ++pixel) {
    for (uint32_t channel = 0; channel < channels; ++channel) {
      image.values.push_back(texels[pixel * stride + first + channel]);
    }
  }
  return image;
}

}  // namespace froth
