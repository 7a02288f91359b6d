// The Cech pairs of a foam that moves. Balls are enlarged by a skin when pairs are found; while no cell has moved and
// grown by more than its skin, no pair that overlaps is missing, for a sum of two such changes is at most both skins.
// Pairs that do not overlap cut nothing (docs/FOAM.md "Graphs").
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "foam/cell_graph.h"
#include "trainer/step/trained_foam.h"

namespace froth {

class SkinPairs {
 public:
  // Finds the pairs again if a ball (site, radius) has left its skin or the count changed; returns whether it did.
  // leastSkin: of small balls [scene units]; others get 1/20 of their radius.
  template <class Real>
  bool follow(const std::vector<glm::vec<4, Real>>& balls, float leastSkin);

  // Whatever has changed: the order of cells is another.
  void forget() { found_.clear(); }

  NeighbourRows rows() const { return {graph_.offsets.data(), graph_.neighbours.data(), reverses_.data()}; }
  const CellGraph& graph() const { return graph_; }

 private:
  void find(float leastSkin);

  std::vector<glm::vec4> found_;  // balls when the pairs were found
  std::vector<float> slacks_;
  CellGraph graph_;
  std::vector<uint32_t> reverses_;
};

}  // namespace froth
