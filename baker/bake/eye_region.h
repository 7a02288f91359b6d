// Which eyes a bake has in mind, and views from there. Internal to baker/bake.
#pragma once

#include <cstdint>
#include <vector>

#include "baker/bake/bake.h"
#include "base/result.h"
#include "foam/foam.h"
#include "format/asset_contents.h"
#include "reference/camera/camera.h"

namespace froth {

Status checkEyes(const BakeOptions& options);

// The region that the options ask for: without a choice the cameras' eyes; without cameras either no boxes.
EyeRegion makeEyeRegion(const BakeOptions& options);

// Views from eyes that lie at random in the region. Every other one looks like the nearest camera; the rest, and all
// of them without cameras, look to any side with a field of view of 90 degrees. Different seeds give other views.
std::vector<View> drawViews(const EyeRegion& region, const CameraSet* cameras, uint32_t count, uint64_t seed);

// From the four corners of a tetrahedron, far enough to see all of the foam: where nobody says from where it is seen.
std::vector<View> viewsAround(const Foam& foam);

// Whether the options name a region beyond the cameras' own eyes.
bool hasChosenEyes(const BakeOptions& options);

}  // namespace froth
