// Random foams of any K and M.
#pragma once

#include <cstdint>
#include <random>

#include "foam/foam.h"

namespace froth::test {

// Cells in [-1, 1]^3 + (0, 0, 3).
inline Foam makeRandomFoam(uint32_t cells, uint32_t details, uint32_t lobes, uint32_t seed) {
  std::mt19937 engine(seed);
  const auto random = [&](float low, float high) {
    return low + (high - low) * (static_cast<float>(engine() >> 8) * (1.0f / 16777216.0f));
  };
  const auto random3 = [&](float size) {
    const float x = random(-size, size), y = random(-size, size), z = random(-size, size);
    return glm::vec3(x, y, z);
  };
  Foam foam;
  foam.cellCount = cells;
  foam.detailCount = details;
  foam.lobeCount = lobes;
  for (uint32_t cell = 0; cell < cells; ++cell) {
    foam.sites.push_back(random3(1) + glm::vec3(0, 0, 3));
    foam.radii.push_back(random(0.1f, 0.35f));
    foam.densities.push_back(random(0.5f, 20));
    const glm::vec3 axis = random3(1);
    foam.orientations.push_back(glm::normalize(glm::vec4(random(0.1f, 1), axis)));
    for (uint32_t detail = 0; detail < details; ++detail) {
      const float u = random(-0.7f, 0.7f), v = random(-0.7f, 0.7f);
      foam.detailSites.push_back({u, v});
      foam.detailHeights.push_back(random(-0.3f, 0.3f));
      for (uint32_t lobe = 0; lobe < lobes; ++lobe) {
        foam.lobeAxes.push_back(random3(3));
        foam.lobeColours.push_back(random3(0.5f));
      }
    }
  }
  return foam;
}

}  // namespace froth::test
