// A small foam with every attribute drawn at random, so that a misplaced one shows.
#pragma once

#include "foam/foam.h"
#include "tests/graph/ball_sets.h"

namespace froth {

inline Foam makeRandomFoam(uint32_t cellCount, uint32_t detailCount, uint32_t lobeCount, uint64_t seed) {
  BallSetMaker random(seed);
  const BallSet balls = random.foamLike(cellCount);
  Foam foam;
  foam.cellCount = cellCount;
  foam.detailCount = detailCount;
  foam.lobeCount = lobeCount;
  foam.sites = balls.sites;
  foam.radii = balls.radii;
  const auto number = [&] { return static_cast<float>(random.uniform(-1, 1)); };
  for (uint32_t i = 0; i < cellCount; ++i) {
    foam.densities.push_back(1 + 10 * std::abs(number()));
    foam.orientations.push_back(glm::normalize(glm::vec4(number(), number(), number(), 0.1f)));
  }
  for (uint32_t k = 0; k < cellCount * detailCount; ++k) {
    foam.detailSites.emplace_back(number(), number());
    foam.detailHeights.push_back(0.1f * number());
  }
  for (uint32_t k = 0; k < cellCount * detailCount * lobeCount; ++k) {
    foam.lobeAxes.emplace_back(number(), number(), number());
    foam.lobeColours.emplace_back(number(), number(), number());
  }
  return foam;
}

// A foam of live, dead, empty, hidden and duplicate cells: a random one, with some cells spoilt.
inline Foam makeMixedFoam() {
  Foam foam = makeRandomFoam(400, 2, 3, 11);
  for (uint32_t i = 0; i < 400; i += 10) foam.densities[i] = 0;
  for (uint32_t i = 1; i < 400; i += 20) foam.sites[i] = foam.sites[i + 1];
  for (uint32_t i = 3; i < 400; i += 20) {  // small, well inside a neighbour: empty or hidden
    foam.radii[i] = 0.05f * foam.radii[i + 1];
    foam.sites[i] = foam.sites[i + 1] + 0.5f * foam.radii[i + 1] * glm::vec3(0, 0, 1);
  }
  return foam;
}

}  // namespace froth
