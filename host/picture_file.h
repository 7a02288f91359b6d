// Pictures of frames, for headless runs and screenshots.
#pragma once

#include <filesystem>
#include <span>

#include "base/image/image.h"
#include "host/host.h"

namespace froth {

// From linear premultiplied RGBA [height * width * 4]: sRGB in 8 bits, over black. Foams are blended in display-coded
// space, so a file of what one sees encodes C / A, not C: A * encode(C / A).
Image encodePicture(std::span<const float> rgba, VkExtent2D extent);

// writeImage() into a folder that need not be there yet.
Status writePicture(const std::filesystem::path& path, const Image& picture);

// Peak signal-to-noise ratio [dB]; +inf for equal pictures. Fails if the sizes differ.
Result<double> comparePictures(const Image& a, const Image& b);

// The pictures, scaled down, in rows of four. All of one size, at least one.
Image contactSheet(std::span<const Image> pictures);

}  // namespace froth
