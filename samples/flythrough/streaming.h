// Levels of detail: what the fly-through asks of streaming, and what it is told.
#pragma once

#include <vector>

#include "host/scene.h"

namespace froth {

struct StreamSettings {
  uint64_t budget = 0;  // [bytes] of device memory for all of Froth; 0: no limit
  float detail = 1;     // FrothStreamInfo
  bool isFrozen = false;
};

Status applySettings(const Scene& scene, const StreamSettings& settings);

// As of the frame at hand.
struct StreamFigures {
  FrothStreamStatus status{};
  std::vector<FrothChunk> chunks;
};

Result<StreamFigures> readFigures(const Scene& scene);

}  // namespace froth
