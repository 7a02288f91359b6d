// What queries and drawing both need of a decoded chunk.
#pragma once

#include <cmath>
#include <vector>

#include <glm/glm.hpp>

#include "format/asset_contents.h"

namespace froth {

// Box of the balls of live cells [scene units]; without any low is above high.
struct LiveBounds {
  glm::dvec3 low{HUGE_VAL}, high{-HUGE_VAL};
};

LiveBounds findLiveBounds(const ChunkContents& contents);

// [cells and ghosts] The site relative to the chunk's origin, and the radius.
std::vector<glm::vec4> joinSitesAndRadii(const ChunkContents& contents);

}  // namespace froth
