// What a fit looks through (level_fit.h). Internal to baker/lod.
#pragma once

#include <span>
#include <vector>

#include "reference/camera/camera.h"

namespace froth {

// At most kMostFitViews of the views; where they are fewer, the rest stand between neighbouring ones. A foam that fits
// few views looks wrong from elsewhere, so a fit looks through many, and through each once.
inline constexpr size_t kMostFitViews = 192;
std::vector<View> chooseFitViews(std::span<const View> views);

}  // namespace froth
