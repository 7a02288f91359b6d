// Exposure of photos. Cameras that choose it themselves show a surface brighter in one photo than in the next, which a
// foam learns as colours that depend on the direction.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "base/result.h"
#include "reference/capture/capture.h"
#include "trainer/photos/photos.h"

namespace froth {

// By how much brighter than the mean of all photos each shows what others show too [natural logarithm of display-coded
// red, green, blue]: what fits best to the capture's points of which it is known who sees them. 0 for photos that show
// few of them. `photos`: of all views, in their order, of any size. kBadInput where no photo shows enough.
Result<std::vector<glm::dvec3>> findExposures(const Capture& capture, const std::vector<Photo>& photos);

// As if it were 0; what gets brighter than white becomes white.
void removeExposure(const glm::dvec3& exposure, Photo& photo);

// All photos of a capture as if taken with one exposure.
Status evenExposures(const Capture& capture, std::vector<Photo>& photos);

}  // namespace froth
