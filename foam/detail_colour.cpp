#include "foam/detail_colour.h"

#include <limits>

#include "shaders/foam/appearance.h"

namespace froth {

glm::vec3 detailColour(const Foam& foam, uint64_t detail, const glm::vec3& direction) {
  const LobeRange lobes = lobesOf(foam, detail);
  float largest = std::numeric_limits<float>::lowest(), weightSum = 0;
  glm::vec3 colourSum(0);
  for (uint64_t m = lobes.first; m < lobes.first + lobes.count; ++m) {
    foam::addLobe(foam::lobeExponent(foam.lobeAxes[m], direction), foam.lobeColours[m], largest, weightSum, colourSum);
  }
  const glm::vec3 base = foam.baseColours.empty() ? glm::vec3(0) : foam.baseColours[detail];
  return foam::lobeColour(base, weightSum, colourSum);
}

}  // namespace froth
