// Keys and mouse that steer a camera.
#pragma once

#include "host/fly_camera.h"

namespace froth {

// W A S D Q E, and dragging with the left button; what ImGui's windows take is left out. Within ImGui's frame.
FlyInput flightInput(double seconds);
double flightSpeedChange();  // factor, by the mouse's wheel

}  // namespace froth
