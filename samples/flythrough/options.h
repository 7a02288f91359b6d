// The command line of froth_flythrough.
#pragma once

#include <filesystem>
#include <string>

#include "host/command_line.h"
#include "samples/flythrough/painter.h"

namespace froth {

struct FlythroughOptions : RunOptions {
  std::string asset;
  std::filesystem::path cameras;  // empty: what the asset has stored
  Picture picture = Picture::kRaster;
  bool isCounting = false;       // the overlay shows what rays cost; slower
  float targetMilliseconds = 0;  // of a window's frames on the GPU; 0: none
};

}  // namespace froth
