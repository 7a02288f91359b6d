#include "runtime/query/chunk_geometry.h"

namespace froth {

LiveBounds findLiveBounds(const ChunkContents& contents) {
  const glm::dvec3 origin(contents.origin[0], contents.origin[1], contents.origin[2]);
  LiveBounds bounds;
  for (uint32_t cell = 0; cell < contents.liveCount; ++cell) {
    const glm::dvec3 site = origin + glm::dvec3(contents.sites[cell]);
    const double radius = contents.radii[cell];
    bounds.low = glm::min(bounds.low, site - radius);
    bounds.high = glm::max(bounds.high, site + radius);
  }
  return bounds;
}

std::vector<glm::vec4> joinSitesAndRadii(const ChunkContents& contents) {
  std::vector<glm::vec4> joined(contents.sites.size());
  for (size_t i = 0; i < joined.size(); ++i) joined[i] = glm::vec4(contents.sites[i], contents.radii[i]);
  return joined;
}

}  // namespace froth
