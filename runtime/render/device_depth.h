// The caller's device depth as the passes need it: what his projection makes of points in an asset's axes and units.
#pragma once

#include "runtime/render/camera_rays.h"

namespace froth {

// Whether points farther along the view axis have lesser device depth. The projection must have a depth (hasDepth).
bool isDepthReversed(const FrothCamera& camera);
// Whether the projection tells near from far, and the viewport has a depth range.
bool hasDepth(const FrothCamera& camera);

// Fills FrameBlock::depthRange, which needs no asset.
void fillDepthRange(const FrothCamera& camera, gpu::FrameBlock& block);
// Fills FrameBlock::depthRow and depthScale. scale: of the instance.
void fillDepthRows(const FrothCamera& camera, const CameraRays& rays, float scale, gpu::FrameBlock& block);

}  // namespace froth
