// Empty balls along rays, and a sparse choice of them: the candidates of Steiner cells.
#pragma once

#include <span>
#include <vector>

#include "baker/steiner/ball_tree.h"
#include "baker/steiner/steiner.h"
#include "baker/steiner/walk_length.h"

namespace froth {

struct EmptyBall {
  glm::vec3 site;
  float radius;
};

// Along each ray from one empty ball to the next, until it has crossed enough density: one ball about a random point of
// every stretch. Each lies on the asset's lattices and keeps a gap from all balls of the tree. In the order of the rays.
std::vector<EmptyBall> findEmptyBalls(const BallTree& tree, std::span<const glm::vec3> sites, std::span<const float> radii,
                                      std::span<const float> densities, std::span<const WalkRay> rays,
                                      const SteinerOptions& options);

// From the largest to the smallest, each that overlaps no kept one by more than a share of the sum of both radii. `balls`
// may come in any order.
std::vector<EmptyBall> thinEmptyBalls(std::vector<EmptyBall> balls);

}  // namespace froth
