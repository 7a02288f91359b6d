// Photos as images of colours.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "base/image/image.h"
#include "trainer/photos/photos.h"

namespace froth {

// Over black, 3 channels; black where a mask ignores the pixel.
Image imageOf(const Photo& photo);
// What training shows of its view (StepExecutor::show), in the same form.
Image imageOf(const Photo& photo, const std::vector<glm::vec4>& shown);

}  // namespace froth
