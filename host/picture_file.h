// Pictures on disk, for headless runs and screenshots.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "host/host.h"

namespace froth {

struct Picture8 {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;  // [height * width * 3] sRGB, over black
};

// From linear premultiplied RGBA [height * width * 4]. Foams are blended in display-coded space, so a file of
// what one sees encodes C / A, not C: A * encode(C / A).
Picture8 encodePicture(std::span<const float> rgba, VkExtent2D extent);

// PNG, written under a temporary name and renamed: a file that is there is whole.
Status writePicture(const std::filesystem::path& path, const Picture8& picture);
Result<Picture8> readPicture(const std::filesystem::path& path);

// Peak signal-to-noise ratio [dB]; +inf for equal pictures. Fails if the sizes differ.
Result<double> comparePictures(const Picture8& a, const Picture8& b);

// The pictures, scaled down, in rows of four. All of one size, at least one.
Picture8 contactSheet(std::span<const Picture8> pictures);

}  // namespace froth
