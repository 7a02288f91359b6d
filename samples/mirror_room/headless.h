// The room without a display: frames on a camera's way around the foam, times, a comparison for CI.
#pragma once

#include "samples/mirror_room/options.h"

namespace froth {

// Draws options.frames (>= 1) frames; writes frame_0000.png ... and contact_sheet.png.
Status showHeadless(const MirrorRoomOptions& options);

}  // namespace froth
