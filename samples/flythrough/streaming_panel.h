// What the overlay tells of streaming, and what one can change of it; for assets with levels of detail.
#pragma once

#include "samples/flythrough/residency_map.h"
#include "samples/flythrough/streaming.h"

namespace froth {

// A window of ImGui. True: `settings` are others now.
bool layOutStreaming(const StreamFigures& figures, const MapCamera& camera, StreamSettings& settings);

}  // namespace froth
