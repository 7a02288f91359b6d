// The rays by which Steiner cells are chosen.
#pragma once

#include <vector>

#include "baker/steiner/steiner.h"
#include "baker/steiner/walk_length.h"
#include "foam/site_tree.h"

namespace froth {

// About `count` rays: three of four through the cameras' views and flight path, if there are some. The others
// know no camera: half of them start at the surfaces of balls, half anywhere in the scene's box, as
// reflections and free flight ask for.
std::vector<WalkRay> makeChoosingRays(std::span<const glm::vec3> sites, std::span<const float> radii,
                                      const SiteTree& tree, const SteinerOptions& options, uint32_t count);

}  // namespace froth
