// Detail sites of a merged cell, from those of both cells. Internal to baker/lod.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "baker/lod/merge_shape.h"
#include "foam/foam.h"

namespace froth {

struct MergedDetails {
  std::vector<glm::dvec2> places;  // [K] [radii of the merged cell]
  std::vector<double> heights;     // [K] [radii]
  // [K * 2K] the colour of a merged detail site as a mix of those of the first cell's, then the second's; rows sum to
  // about 1, and values may be negative, where the blend of a face blurs more than that of the finer ones.
  std::vector<double> mix;
  std::vector<uint32_t> heaviest;  // [K] the detail site, of both cells', that a merged one shows most of
};

MergedDetails mergeDetails(const Foam& cells, const MergeParts& parts, const MergedShape& shape, bool keepsPlain);

}  // namespace froth
