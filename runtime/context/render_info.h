// Checks what a record call is given and fills in its defaults.
#pragma once

#include "froth/froth.h"
#include "runtime/device/messages.h"
#include "runtime/render/view_renderer.h"

namespace froth {

// On FROTH_OK every field of `info` is finite and final: scissor is the rectangle to draw, inside the
// viewport and all images and not larger than `maxExtent`; the lens is of one of the `lensClasses` (FrothLensClass
// bits), and its rayMap is null unless that is what it is; cutoff >= 0, quantile in (0, 1), maxSteps >
// 0. The two near limits may still be FROTH_NEAR_DEFAULT. `call` names the entry point in messages.
FrothResult resolveRenderInfo(const Messages& messages, const char* call, VkExtent2D maxExtent, uint32_t lensClasses,
                              FrothRenderInfo& info);

// Fills in the near limits of an instance: the asset's where the caller left them to it, none where the lens has no use
// for them.
void resolveNearLimits(const FrothRenderInfo& info, RenderInstance& instance);

}  // namespace froth
