// What assets and views will take, told without a device.
#pragma once

#include "froth/froth_estimate.h"
#include "runtime/device/messages.h"

namespace froth {

// info: its asset and view are read to today's size; view may be null.
FrothResult estimateMemory(const Messages& messages, const char* call, const FrothEstimateInfo& info,
                           FrothMemoryEstimate& estimate);

}  // namespace froth
