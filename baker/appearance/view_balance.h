// Weights of views: bytes go where the worst view needs them.
#pragma once

#include <vector>

#include "baker/appearance/appearance.h"
#include "baker/appearance/axis_codebook.h"

namespace froth {

// [views] By which errors in the views have to count so that colours come out with about the same error in
// each of them; found by coding a sample of cells some times over. Empty if that is stopped on request. The
// same on any number of threads.
std::vector<float> balanceViews(const Foam& foam, const Visibility& visibility, const AxisCodebook& codebook,
                                const AppearanceOptions& options, const Progress& progress);

}  // namespace froth
