// The room in a window: fly, pick with the mouse, drop the ball again.
#pragma once

#include "samples/mirror_room/options.h"

namespace froth {

// Until the window is closed, or for options.frames frames.
Status showInWindow(const MirrorRoomOptions& options);

}  // namespace froth
