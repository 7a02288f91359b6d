// What the passes over hits know of a frame: the camera now and before, and how each instance moved. All in double
// until it is written.
#pragma once

#include "runtime/render/frame_images.h"
#include "runtime/render/view_renderer.h"
#include "shaders/gpu/layout.h"

namespace froth {

// Everything but the two addresses.
void fillHitBlock(const FrothRenderInfo& info, gpu::HitBlock& block);

// Of an instance as it is drawn.
gpu::HitInstance describeHitInstance(const FrothRenderInfo& info, const RenderInstance& instance);

}  // namespace froth
