// Foams for the tests of levels of detail.
#pragma once

#include "foam/foam.h"

namespace froth {

// All lobes have one colour: the foam looks the same from everywhere.
inline Foam withOneColour(Foam foam, const glm::vec3& colour) {
  for (glm::vec3& lobe : foam.lobeColours) lobe = colour - 0.5f;
  for (glm::vec3& base : foam.baseColours) base = colour - 0.5f;
  return foam;
}

// Half as bright, or any other part.
inline Foam withDimmedColours(Foam foam, float factor) {
  for (glm::vec3& lobe : foam.lobeColours) lobe = (lobe + 0.5f) * factor - 0.5f;
  return foam;
}

// The same foam in other units.
inline Foam scaleFoam(Foam foam, float factor) {
  for (glm::vec3& site : foam.sites) site *= factor;
  for (float& radius : foam.radii) radius *= factor;
  for (float& density : foam.densities) density /= factor;
  return foam;
}

// Base colours in the place of lobes.
inline Foam withBaseColours(Foam foam) {
  foam.lobeCount = 0;
  foam.lobeAxes.clear();
  foam.lobeColours.clear();
  foam.baseColours.assign(foam.detailSites.size(), glm::vec3(0.1f, 0.2f, -0.3f));
  return foam;
}

}  // namespace froth
