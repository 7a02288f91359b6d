// What `froth train --preset` sets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace froth {

struct TrainPreset {
  std::string name;
  uint32_t leastSteps = 0, mostSteps = 0;  // stepsFor()
  uint32_t leastCells = 0, mostCells = 0;  // cellsFor()
  uint32_t startCells = 0;                 // 0: a quarter
  bool isMaskAlpha = false;
};

// The first is the default.
const std::vector<TrainPreset>& trainPresets();
// One of those.
const TrainPreset& trainPreset(const std::string& name);

// How many steps a training takes: 80 for each photo that trains, within the preset's bounds.
uint32_t stepsFor(const TrainPreset& preset, size_t photos);

// How many cells a foam gets: two for each point of the capture, within the preset's bounds. What has more texture has
// more points.
uint32_t cellsFor(const TrainPreset& preset, size_t points);

}  // namespace froth
