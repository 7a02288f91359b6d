// Views of fewer pixels, for measures that need no more.
#pragma once

#include <algorithm>
#include <cmath>

#include "reference/camera/camera.h"

namespace froth {

// The same view with about `pixels` pixels, if it has more.
inline View shrinkView(const View& view, double pixels) {
  const double scale = std::min(1.0, std::sqrt(pixels / (double{1} * view.width * view.height)));
  const auto reduce = [&](uint32_t size) { return std::max(1u, static_cast<uint32_t>(std::lround(size * scale))); };
  return resizeView(view, reduce(view.width), reduce(view.height));
}

}  // namespace froth
