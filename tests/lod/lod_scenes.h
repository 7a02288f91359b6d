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

// Base colours in the place of lobes.
inline Foam withBaseColours(Foam foam) {
  foam.lobeCount = 0;
  foam.lobeAxes.clear();
  foam.lobeColours.clear();
  foam.baseColours.assign(foam.detailSites.size(), glm::vec3(0.1f, 0.2f, -0.3f));
  return foam;
}

}  // namespace froth
