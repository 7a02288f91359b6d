// Checks and defaults of what the caller passes, for calls of a context and for those that need none.
#pragma once

#include "froth/froth.h"
#include "runtime/device/messages.h"

namespace froth {

inline constexpr uint32_t kDefaultFramesInFlight = 2;
inline constexpr uint32_t kMostFadeFrames = 64;       // FrothViewInfo::fadeFrames
inline constexpr uint32_t kReservedCells = 1u << 20;  // FrothViewInfo::reserveCells
inline constexpr float kDefaultCutoff = 1e-3f, kDefaultQuantile = 0.5f;

FrothResult checkSource(const Messages& messages, const char* call, const FrothAssetInfo& info);
// The same, for calls that return when they have read it: not a reader.
FrothResult checkSourceAtHand(const Messages& messages, const char* call, const FrothAssetInfo& info);
FrothResult checkExtent(const Messages& messages, const char* call, VkExtent2D maxExtent);
FrothResult checkFramesInFlight(const Messages& messages, const char* call, uint32_t framesInFlight);

}  // namespace froth
