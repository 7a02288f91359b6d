// Pictures small enough for a page.
#pragma once

#include "base/image/image.h"

namespace froth {

// Means over squares of pixels, whole ones alone, so many that the width is bounded. Of three channels.
Image shrinkToWidth(const Image& image, uint32_t mostWidth);

}  // namespace froth
