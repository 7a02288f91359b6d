// A small foam with every attribute drawn at random, so that a misplaced one shows.
#pragma once

#include "baker/foam.h"
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

}  // namespace froth
