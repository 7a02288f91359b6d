#include "foam/morton_order.h"

#include <algorithm>
#include <utility>

#include <tbb/parallel_sort.h>

#include "base/morton_code.h"

namespace froth {
namespace {

constexpr int kBitsPerAxis = 21;  // 63 of a 64-bit key

}  // namespace

std::vector<uint32_t> mortonOrder(std::span<const glm::vec3> sites) {
  if (sites.empty()) return {};
  glm::dvec3 low(sites[0]), high(sites[0]);
  for (const glm::vec3& site : sites) {
    low = glm::min(low, glm::dvec3(site));
    high = glm::max(high, glm::dvec3(site));
  }
  const glm::dvec3 size = high - low;
  const double extent = std::max({size.x, size.y, size.z});  // one scale for all axes keeps the curve's boxes cubes
  const double scale = extent > 0 ? (double{1u << kBitsPerAxis} - 1) / extent : 0;

  std::vector<std::pair<uint64_t, uint32_t>> keys(sites.size());
  for (uint32_t i = 0; i < sites.size(); ++i) {
    const glm::uvec3 place((glm::dvec3(sites[i]) - low) * scale);
    keys[i] = {mortonCode({place.x, place.y, place.z}), i};
  }
  tbb::parallel_sort(keys.begin(), keys.end());
  std::vector<uint32_t> order(sites.size());
  std::transform(keys.begin(), keys.end(), order.begin(), [](const auto& key) { return key.second; });
  return order;
}

}  // namespace froth
