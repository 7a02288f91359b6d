// The images that are made from hits: id and motion, each by a small pass after those of raster, walk or clear.
#pragma once

#include "runtime/render/view_state.h"

namespace froth {

// Fills what a recording that wants hits needs besides: of its FrameBlock, and the HitBlock behind it in `staged`. instance: null
// for a clear.
void writeHits(const Recording& recording, const RenderInstance* instance, gpu::FrameBlock& block, char* staged);

void recordHitPasses(const Recording& recording, const RenderPipelines::State& pipelines);

}  // namespace froth
