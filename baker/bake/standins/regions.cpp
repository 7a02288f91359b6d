#include "baker/graph/graph.h"
namespace froth {
[[gnu::weak]] Result<RegularTriangulation> triangulateRegions(std::span<const glm::vec3> sites, std::span<const float> radii,
                                                std::span<const uint32_t>, uint32_t, const Progress& progress) {
  return triangulateRegular(sites, radii, progress);
}
}  // namespace froth
