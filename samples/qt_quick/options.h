// The command line of froth_qt_quick.
#pragma once

#include <string>

#include "host/command_line.h"

namespace froth {

struct QtQuickOptions : RunOptions {
  std::string asset;
  VkExtent2D resized{};  // headless: size of the window for the last half of the frames; {0, 0}: as before
};

}  // namespace froth
