// Rays by brute force in double: every ball that a ray meets, cut by all Cech neighbours, in the order of the origin's
// powers. The rules of reference/render/ray.h, without any triangulation.
#pragma once

#include <vector>

#include "foam/cell_graph.h"
#include "foam/foam.h"
#include "foam/site_tree.h"

namespace froth::test {

struct ReferenceHit {
  double transmittance = 1;
  double distance = -1;  // -1: never below the quantile
};

class ReferenceRays {
 public:
  // Keeps a reference to the foam.
  explicit ReferenceRays(const Foam& foam);

  // `direction` has unit length. Any thread.
  ReferenceHit cast(const glm::dvec3& origin, const glm::dvec3& direction, double tEnd, double quantile,
                    double cutoff) const;

 private:
  const Foam& foam_;
  SiteTree tree_;
  CellGraph pairs_;
};

}  // namespace froth::test
