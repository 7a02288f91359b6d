// Morton (Z) order of sites.
#include <algorithm>
#include <utility>

#include <tbb/parallel_sort.h>

#include "baker/graph/graph.h"

namespace froth {
namespace {

constexpr int kBitsPerAxis = 21;  // 63 of a 64-bit key

// Spreads the low 21 bits of a value to every third bit.
uint64_t spreadBits(uint64_t value) {
  value = (value | value << 32) & 0x001f00000000ffff;
  value = (value | value << 16) & 0x001f0000ff0000ff;
  value = (value | value << 8) & 0x100f00f00f00f00f;
  value = (value | value << 4) & 0x10c30c30c30c30c3;
  return (value | value << 2) & 0x1249249249249249;
}

}  // namespace

std::vector<uint32_t> mortonOrder(std::span<const glm::vec3> sites) {
  if (sites.empty()) return {};
  glm::dvec3 low(sites[0]), high(sites[0]);
  for (const glm::vec3& site : sites) {
    low = glm::min(low, glm::dvec3(site));
    high = glm::max(high, glm::dvec3(site));
  }
  const glm::dvec3 size = high - low;
  const double extent =
      std::max({size.x, size.y, size.z});  // one scale for all axes keeps the curve's boxes cubes
  const double scale = extent > 0 ? (double{1u << kBitsPerAxis} - 1) / extent : 0;

  std::vector<std::pair<uint64_t, uint32_t>> keys(sites.size());
  for (uint32_t i = 0; i < sites.size(); ++i) {
    const glm::u64vec3 place((glm::dvec3(sites[i]) - low) * scale);
    keys[i] = {spreadBits(place.x) | spreadBits(place.y) << 1 | spreadBits(place.z) << 2, i};
  }
  tbb::parallel_sort(keys.begin(), keys.end());
  std::vector<uint32_t> order(sites.size());
  std::transform(keys.begin(), keys.end(), order.begin(), [](const auto& key) { return key.second; });
  return order;
}

}  // namespace froth
