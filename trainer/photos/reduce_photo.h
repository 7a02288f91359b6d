// Smaller photos for early steps.
#pragma once

#include "trainer/photos/photos.h"

namespace froth {

// Sides halved so often and rounded, at least 1; the view's intrinsics with them.
Photo reducePhoto(const Photo& photo, uint32_t halvings);

}  // namespace froth
