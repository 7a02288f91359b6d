// A Qt Quick window with a foam among its items.
#pragma once

#include "samples/qt_quick/options.h"

namespace froth {

// Runs Qt's event loop until the window is closed, or options.frames frames have shown the whole foam. A
// QGuiApplication exists.
Status showWindow(const QtQuickOptions& options);

}  // namespace froth
