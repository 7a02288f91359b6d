// Empty balls along rays: the candidates of Steiner cells.
#pragma once

#include <span>
#include <vector>

#include "baker/steiner/ray_cells.h"
#include "baker/steiner/steiner.h"
#include "baker/steiner/walk_length.h"
#include "foam/site_tree.h"

namespace froth {

struct EmptyBall {
  glm::vec3 site;
  float radius;
};

// Finds balls that lie on the asset's lattices and keep a gap from all balls of the tree. Thread-safe.
class EmptyBallFinder {
 public:
  // Keeps references to all that it is given.
  EmptyBallFinder(const SiteTree& tree, std::span<const glm::vec3> sites, std::span<const float> radii,
                  const SteinerOptions& options);

  // Appends balls about random points of some of the ray's empty intervals, moved to where there is more
  // room. `stream`
  // [< 2^32] tells the random numbers of several rays apart.
  void findAlong(const WalkRay& ray, const RayCells& cells, uint64_t stream, std::vector<EmptyBall>& found) const;

  // Appends the ball about a point outside of all balls, moved `tries` times to where there is more room; none where no
  // ball fits.
  void findAt(const glm::dvec3& point, uint32_t tries, std::vector<EmptyBall>& found) const {
    addBall(climb(point, tries), found);
  }

 private:
  struct Place {
    glm::dvec3 point;
    NearestSite nearest;
  };
  Place climb(const glm::dvec3& start, uint32_t tries) const;
  void addBall(const Place& place, std::vector<EmptyBall>& found) const;

  const SiteTree& tree_;
  std::span<const glm::vec3> sites_;
  std::span<const float> radii_;
  const SteinerOptions& options_;
  double leastClearance_ = 0;
  glm::vec3 low_, high_;  // of the sites: the asset's position lattice reaches no farther
};

// Keeps the first of all balls that nearly coincide.
void dropTwins(std::vector<EmptyBall>& balls);

}  // namespace froth
