// What a detail site of a foam looks like.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "foam/foam.h"

namespace froth {

// Display-coded colour of detail site `detail` = cell * K + k along a unit direction, by its lobes
// (shaders/foam/appearance.h).
glm::vec3 detailColour(const Foam& foam, uint64_t detail, const glm::vec3& direction);

}  // namespace froth
