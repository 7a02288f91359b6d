// The fly-through in a window: an engine's loop around Froth.
#pragma once

#include "samples/flythrough/options.h"

namespace froth {

// Until the window is closed, or for options.frames frames.
Status flyInWindow(const FlythroughOptions& options);

}  // namespace froth
