#include "samples/mirror_room/window.h"
namespace froth {
Status showInWindow(const MirrorRoomOptions&) { return {}; }
}  // namespace froth
