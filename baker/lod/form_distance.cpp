#include "baker/lod/form_distance.h"

#include <cmath>
#include <numeric>
#include <vector>

#include "foam/site_tree.h"

namespace froth {

double measureFormDistance(const Foam& fine, const Foam& coarse) {
  std::vector<uint32_t> all(coarse.cellCount);
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<float> points(coarse.cellCount, 0.0f);  // the nearest site is that of least power
  const SiteTree tree(coarse.sites, points, all);
  double sum = 0;
  for (const glm::vec3& site : fine.sites) sum += std::fmax(tree.findLeastPower(site).value, 0);
  return std::sqrt(sum / std::fmax(fine.cellCount, 1));
}

}  // namespace froth
