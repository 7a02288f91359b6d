// A view of cameras.json as the runtime takes it.
#pragma once

#include "base/image/image.h"
#include "froth/froth.h"
#include "froth/froth_walk.h"
#include "reference/camera/camera.h"
#include "reference/camera/view_rays.h"
#include "reference/capture/view_selection.h"

namespace froth {

// FrothLensClass bits that views need.
uint32_t lensClassesOf(const View& view);
uint32_t lensClassesOf(const std::vector<SelectedView>& views);

// The scene's depth as a camera has it that is made with the same ends, of distances along the rays: device depth, or
// with lenses that are no projection the distances themselves. What lies behind the eye is at it.
std::vector<float> sceneDepthOf(const View& view, const Image& distances);

// Everything but the image of a ray map. `ends`: what the scene's depth will hold, if there is one.
FrothCamera cameraOf(const View& view, const Image* ends = nullptr);

// Relative to the view's eye. `end`: as FrothGpuRay::tMax.
FrothGpuRay gpuRayOf(const View& view, const ViewRay& ray, float end);

}  // namespace froth
