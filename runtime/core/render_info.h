// Checks what a record call is given and fills in its defaults.
#pragma once

#include "froth/froth.h"
#include "runtime/asset/gpu_asset.h"
#include "runtime/core/messages.h"

namespace froth {

// On FROTH_OK every field of `info` is finite and final: scissor is the rectangle to draw, inside the
// viewport and all images and not larger than `maxExtent`; the lens is of one of the `lensClasses` (FrothLensClass bits), and
// its rayMap is null unless that is what it is; cutoff >= 0, depthQuantile in (0, 1), maxSteps >
// 0. The two near limits may still be FROTH_NEAR_DEFAULT. `call` names the entry point in messages.
FrothResult resolveRenderInfo(const Messages& messages, const char* call, VkExtent2D maxExtent,
                              uint32_t lensClasses, FrothRenderInfo& info);

// Takes the asset's near limits where the caller left them to it, and drops those that the lens has no use for. `scale` of the
// instance: nearDepth is in world units.
void resolveNearLimits(const GpuAsset& asset, float scale, FrothRenderInfo& info);

}  // namespace froth
