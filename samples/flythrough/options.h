// The command line of froth_flythrough.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "samples/flythrough/painter.h"

namespace froth {

struct FlythroughOptions {
  std::string asset;
  std::filesystem::path cameras;  // empty: what the asset has stored
  VkExtent2D extent{1280, 720};
  Picture picture = Picture::kRaster;
  std::string device;            // index or part of a name; empty: the first suitable one
  bool validate = false;         // validation layers; a message fails the run
  bool isCounting = false;       // the overlay shows what rays cost; slower
  uint32_t frames = 0;           // end after so many; 0: until the window is closed
  std::filesystem::path output;  // folder of frames and screenshots

  bool isHeadless = false;
  std::filesystem::path compare;  // empty, or the picture that the last frame must resemble
  double minPsnr = 40;            // [dB]
};

}  // namespace froth
