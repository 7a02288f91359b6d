#include "reference/camera/ray_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <system_error>

#include "base/atomic_file.h"

namespace froth {
namespace {

static_assert(sizeof(glm::vec3) == 12);

// The two pixels around a place along one side, and how far it lies from the first to the second.
struct Between {
  uint32_t first, second;
  float share;
};

Between betweenPixels(uint32_t index, uint32_t count, uint32_t sourceCount) {
  const double place = (index + 0.5) * sourceCount / count - 0.5;
  const double clamped = std::clamp(place, 0.0, double(sourceCount - 1));
  const auto first = static_cast<uint32_t>(clamped);
  return {first, std::min(first + 1, sourceCount - 1), static_cast<float>(clamped - first)};
}

}  // namespace

Result<RayMap> readRayMap(const std::filesystem::path& path, uint32_t width, uint32_t height) {
  const uint64_t expected = uint64_t{width} * height * sizeof(glm::vec3);
  std::error_code error;
  const uint64_t size = std::filesystem::file_size(path, error);
  if (!error && size != expected) {
    return makeError(ErrorKind::kBadInput, "%s: found %llu bytes; give %llu: three floats for each of %u x %u pixels",
                     path.c_str(), static_cast<unsigned long long>(size), static_cast<unsigned long long>(expected),
                     width, height);
  }
  const Result<std::vector<uint8_t>> bytes = readFile(path);
  if (!bytes) return bytes.error();
  if (bytes->size() != expected) {
    return makeError(ErrorKind::kBadInput, "%s: its length changed while it was read; try again", path.c_str());
  }
  RayMap map{width, height, std::vector<glm::vec3>(size_t{width} * height)};
  std::memcpy(map.directions.data(), bytes->data(), bytes->size());
  for (size_t i = 0; i < map.directions.size(); ++i) {
    const glm::dvec3 given(map.directions[i]);
    const double length = glm::length(given);
    if (!std::isfinite(length)) {
      return makeError(ErrorKind::kBadInput, "%s: pixel (%zu, %zu): found (%g, %g, %g); give finite numbers",
                       path.c_str(), i % width, i / width, given.x, given.y, given.z);
    }
    if (length > 0) map.directions[i] = given / length;
  }
  return map;
}

Status writeRayMap(const std::filesystem::path& path, const RayMap& map) {
  return writeFileAtomically(
      path, {reinterpret_cast<const uint8_t*>(map.directions.data()), map.directions.size() * sizeof(glm::vec3)});
}

RayMap resizeRayMap(const RayMap& map, uint32_t width, uint32_t height) {
  if (width == map.width && height == map.height) return map;
  RayMap resized{width, height, std::vector<glm::vec3>(size_t{width} * height)};
  const auto at = [&](uint32_t x, uint32_t y) { return map.directions[size_t{y} * map.width + x]; };
  for (uint32_t y = 0; y < height; ++y) {
    const Between row = betweenPixels(y, height, map.height);
    for (uint32_t x = 0; x < width; ++x) {
      const Between column = betweenPixels(x, width, map.width);
      const glm::vec3 corners[] = {at(column.first, row.first), at(column.second, row.first),
                                   at(column.first, row.second), at(column.second, row.second)};
      const bool isWhole =
          std::all_of(std::begin(corners), std::end(corners), [](const glm::vec3& d) { return d != glm::vec3(0); });
      const glm::vec3 mean = glm::mix(glm::mix(corners[0], corners[1], column.share),
                                      glm::mix(corners[2], corners[3], column.share), row.share);
      glm::vec3& direction = resized.directions[size_t{y} * width + x];
      direction = isWhole && mean != glm::vec3(0) ? glm::normalize(mean)
                                                  : corners[(column.share > 0.5f) + 2 * (row.share > 0.5f)];
    }
  }
  return resized;
}

}  // namespace froth
