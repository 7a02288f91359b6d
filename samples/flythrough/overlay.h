// What the overlay tells: what Froth did in the newest complete frames, and the keys.
#pragma once

#include <string>

#include "host/pass_history.h"
#include "host/scene.h"

namespace froth {

struct OverlayContent {
  const char* picture = "";  // nameOf(Picture)
  const char* camera = "";   // "path", "free flight"
  float scale = 1;           // of the picture's width and height: --target-ms
  FrothAssetStatus asset{};
  FrothFrameStatus frame{};
  FrothViewStatus view{};
  bool hasLevels = false;
  std::string followed;  // how --follow goes; empty: without
};

class Overlay {
 public:
  void layOut(const OverlayContent& content, VkExtent2D extent);

 private:
  PassHistory history_;
};

}  // namespace froth
