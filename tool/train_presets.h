// What `froth train --preset` sets.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace froth {

struct TrainPreset {
  std::string name;
  uint32_t steps = 0, cells = 0, startCells = 0;
  bool isMaskAlpha = false;
};

// The first is the default.
const std::vector<TrainPreset>& trainPresets();
// One of those.
const TrainPreset& trainPreset(const std::string& name);

}  // namespace froth
