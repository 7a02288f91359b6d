#include "tool/train_presets.h"

#include <algorithm>

namespace froth {
namespace {

uint32_t inBounds(size_t wanted, uint32_t least, uint32_t most) {
  return static_cast<uint32_t>(std::clamp<size_t>(wanted, least, most));
}

}  // namespace

const std::vector<TrainPreset>& trainPresets() {
  static const std::vector<TrainPreset> presets = {
      {"default", 12000, 30000, 40000, 120000},
      {"fast", 5000, 5000, 40000, 40000},
      {"best", 30000, 30000, 500000, 500000, 100000},       // the published recipe for rooms
      {"object", 30000, 30000, 50000, 50000, 20000, true},  // the published recipe for objects
  };
  return presets;
}

const TrainPreset& trainPreset(const std::string& name) {
  return *std::ranges::find(trainPresets(), name, &TrainPreset::name);
}

uint32_t stepsFor(const TrainPreset& preset, size_t photos) {
  return inBounds(80 * photos, preset.leastSteps, preset.mostSteps);
}

uint32_t cellsFor(const TrainPreset& preset, size_t points) {
  return inBounds(2 * points, preset.leastCells, preset.mostCells);
}

}  // namespace froth
