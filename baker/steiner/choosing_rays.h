// The rays by which Steiner cells are chosen.
#pragma once

#include <vector>

#include "baker/steiner/ball_tree.h"
#include "baker/steiner/steiner.h"
#include "baker/steiner/walk_length.h"

namespace froth {

// About `count` rays: of the cameras' views and flight path if there are some, and as many again that know no camera, half
// of them from the surfaces of balls, half from anywhere in the scene's box, as reflections and free flight ask for.
std::vector<WalkRay> makeChoosingRays(std::span<const glm::vec3> sites, std::span<const float> radii,
                                      const BallTree& tree, const SteinerOptions& options, uint32_t count);

}  // namespace froth
