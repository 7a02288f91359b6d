// A direction per pixel, for lenses that no formula describes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <glm/glm.hpp>

#include "base/result.h"

namespace froth {

// All rays start at the eye.
struct RayMap {
  uint32_t width = 0, height = 0;
  std::vector<glm::vec3> directions;  // [height * width] camera axes, of unit length, or 0: the pixel has no ray
};

// Raw little-endian floats, three per pixel, row-major from the top left. Lengths need not be 1. Fails where the file
// has another length or holds a number that is not finite.
Result<RayMap> readRayMap(const std::filesystem::path& path, uint32_t width, uint32_t height);
Status writeRayMap(const std::filesystem::path& path, const RayMap& map);

// Between four rays the mean; beside a pixel without one, the nearest.
RayMap resizeRayMap(const RayMap& map, uint32_t width, uint32_t height);

}  // namespace froth
