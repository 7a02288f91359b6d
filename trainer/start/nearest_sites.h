// The nearest sites of a place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "foam/site_tree.h"

namespace froth {

struct NearSite {
  double squared = 0;  // distance squared
  uint32_t site = 0;
};

// At most `count`, nearest first, equals by index. A site at the place itself is one of them.
std::vector<NearSite> findNearestSites(const SiteTree& tree, std::span<const glm::vec3> sites, const glm::dvec3& place,
                                       uint32_t count);

}  // namespace froth
