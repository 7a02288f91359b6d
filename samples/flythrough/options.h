// The command line of froth_flythrough.
#pragma once

#include <filesystem>
#include <string>

#include "host/command_line.h"
#include "samples/flythrough/foam_follower.h"
#include "samples/flythrough/painter.h"
#include "samples/flythrough/streaming.h"

namespace froth {

struct FlythroughOptions : RunOptions {
  std::string asset;
  FoamFollower* follower = nullptr;  // --follow: what it bakes takes the place of its first asset; null: none
  std::filesystem::path cameras;     // empty: what the asset has stored
  Picture picture = Picture::kRaster;
  StreamSettings streaming;
  bool isSettled = false;        // headless: frames wait until what is wanted is drawn
  std::filesystem::path json;    // headless; empty: none
  bool isCounting = false;       // the overlay shows what rays cost; slower
  float targetMilliseconds = 0;  // of a window's frames on the GPU; 0: none
};

}  // namespace froth
