// The fly-through without a display: frames, a contact sheet, and a comparison for CI.
#pragma once

#include "samples/flythrough/options.h"

namespace froth {

// Flies the whole path in options.frames (>= 1) frames; writes frame_0000.png ... and contact_sheet.png.
Status flyHeadless(const FlythroughOptions& options);

}  // namespace froth
