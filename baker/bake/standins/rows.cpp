#include <algorithm>
#include <tuple>

#include "format/graph_rows.h"

namespace froth {
void sortGraphRows(ChunkContents& chunk, uint32_t first, uint32_t last) {
  for (uint32_t i = first; i < last; ++i) {
    const auto distance = [&](uint32_t j) {
      const glm::dvec3 d = glm::dvec3(chunk.sites[j]) - glm::dvec3(chunk.sites[i]);
      const double a = chunk.radii[i], b = chunk.radii[j];
      return 0.5 * (glm::dot(d, d) + (a - b) * (a + b)) / glm::length(d);
    };
    const auto before = [&](uint32_t a, uint32_t b) {
      return std::tuple(distance(a), a) < std::tuple(distance(b), b);
    };
    const auto row = chunk.neighbours.begin() + chunk.neighbourOffsets[i];
    const auto end = chunk.neighbours.begin() + chunk.neighbourOffsets[i + 1];
    const auto middle = row + (i < chunk.liveCount ? chunk.alphaCounts[i] : 0);
    std::sort(row, middle, before);
    std::sort(middle, end, before);
  }
}
}  // namespace froth
