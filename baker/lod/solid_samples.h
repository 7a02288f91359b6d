// Points that stand for what a cell shows: of its solid part and of its displaced face.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "foam/cell_graph.h"
#include "foam/foam.h"

namespace froth {

// All relative to the cell's site [scene units, world axes]; neither list is empty.
struct CellSamples {
  std::vector<glm::dvec3> solid;  // evenly over the solid part
  double solidVolume = 0;         // [scene units cubed] > 0
  std::vector<glm::dvec3> face;   // evenly over the displaced face, as far as it lies in the cell
  std::vector<double> shares;     // [face * K] soft Voronoi shares of the cell's detail sites there
};

// `pairs`: a superset of the neighbours that cut bounded cells. The foam must outlive it; thread-safe.
class CellSampler {
 public:
  CellSampler(const Foam& foam, const CellGraph& pairs) : foam_(foam), pairs_(pairs) {}

  CellSamples sample(uint32_t cell) const;

 private:
  const Foam& foam_;
  const CellGraph& pairs_;
};

}  // namespace froth
