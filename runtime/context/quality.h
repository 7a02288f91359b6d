// The controller of froth_quality.h.
#pragma once

#include "froth/froth_quality.h"
#include "runtime/device/messages.h"

namespace froth {

FrothResult stepQuality(const Messages& messages, const char* call, FrothQualityInfo info,
                        const FrothQualityTimes& times, FrothQuality& quality);

}  // namespace froth
