// What a fit looks through (level_fit.h). Internal to baker/lod.
#pragma once

#include <span>
#include <vector>

#include "reference/camera/camera.h"

namespace froth {

// kFitViews that stand between neighbouring views: errors are measured in the views themselves, which a fit should not
// know. A foam that fits few views looks wrong from elsewhere, so a fit looks through many, and through each once. None
// between fewer than two views.
inline constexpr size_t kFitViews = 384;
std::vector<View> chooseFitViews(std::span<const View> views);

}  // namespace froth
