// Smaller photos.
#pragma once

#include <cstdint>
#include <vector>

namespace froth {

// A side of `pixels` reduced by a factor >= 1: rounded, at least 1.
uint32_t reducedSide(uint32_t pixels, double factor);

// Each pixel is the mean over the rectangle of the large image that it covers, with the shares of pixels at its edge.
// rgba: [height * width * 4], premultiplied. `toWidth`, `toHeight` are at most width and height.
std::vector<uint8_t> reducePixels(const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height, uint32_t toWidth,
                                  uint32_t toHeight);

// The same of flags [height * width]: one is set where all that it covers are.
std::vector<uint8_t> reduceFlags(const std::vector<uint8_t>& flags, uint32_t width, uint32_t height, uint32_t toWidth,
                                 uint32_t toHeight);

}  // namespace froth
