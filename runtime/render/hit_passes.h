// The images that are made from hits: id, motion and reactive, each by a small pass after those of raster, walk or
// clear.
#pragma once

#include "runtime/render/view_state.h"

namespace froth {

inline constexpr uint32_t kHitImages = 3;

// Fills what `part` of a recording that wants hits needs besides, of its FrameBlock.
void describeHits(const Recording& recording, uint32_t part, gpu::FrameBlock& block);

// Fills the HitBlock, which lies behind the FrameBlock of the first part. instance: of each part; null for a clear.
void writeHits(const Recording& recording, uint32_t part, const RenderInstance* instance);

void recordHitPasses(const Recording& recording);

}  // namespace froth
