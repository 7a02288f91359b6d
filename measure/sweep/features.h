// What each part of a scene costs: with it and without it, measured.
#pragma once

#include <filesystem>
#include <vector>

#include "measure/sweep/measure.h"

namespace froth {

// Parts of the asset: view dependence, displacement, more than one detail site, walk graph, Steiner cells. A part that
// the scene has is taken out, one that it lacks is put in, with as little as the preset keeps. `folder` exists; needs
// the foam.
Result<std::vector<FeatureCost>> assetFeatures(const Bench& bench, const FoamInput& input, const CameraSet& cameras,
                                               const std::filesystem::path& folder, const Progress& progress);

// Parts of the runtime that the default asset's frames do without: images of distance and normal, what ids and motion
// need, other lenses.
Result<std::vector<FeatureCost>> runtimeFeatures(const Bench& bench, const GpuDeviceOptions& device,
                                                 const Progress& progress);

// What the bake of the default asset did not write [bytes before compression].
Result<std::vector<FeatureCost>> bakeLeftOut(const Bench& bench);

}  // namespace froth
