#include "trainer/start/nearest_sites.h"

#include <algorithm>
#include <tuple>

namespace froth {

std::vector<NearSite> findNearestSites(const SiteTree& tree, std::span<const glm::vec3> sites, const glm::dvec3& place,
                                       uint32_t count) {
  std::vector<NearSite> nearest;  // a sorted list: `count` is small
  nearest.reserve(count + 1);
  double limit = HUGE_VAL;
  const auto bound = [&](const SiteTree::Node& node) {
    const glm::dvec3 gap = gapTo(node.box, place);
    return glm::dot(gap, gap);
  };
  tree.search(limit, bound, [&](uint32_t position) {
    const uint32_t site = tree.order()[position];
    const glm::dvec3 offset = glm::dvec3(sites[site]) - place;
    const NearSite found{glm::dot(offset, offset), site};
    const auto isNearer = [](const NearSite& a, const NearSite& b) {
      return std::tie(a.squared, a.site) < std::tie(b.squared, b.site);
    };
    nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), found, isNearer), found);
    if (nearest.size() > count) nearest.pop_back();
    if (nearest.size() == count) limit = nearest.back().squared;
  });
  return nearest;
}

}  // namespace froth
