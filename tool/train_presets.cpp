#include "tool/train_presets.h"

#include <algorithm>

namespace froth {

const std::vector<TrainPreset>& trainPresets() {
  static const std::vector<TrainPreset> presets = {
      {"default", 12000, 40000, 120000},
      {"fast", 5000, 40000, 40000},
      {"best", 30000, 500000, 500000, 100000},       // the published recipe for rooms
      {"object", 30000, 50000, 50000, 20000, true},  // the published recipe for objects
  };
  return presets;
}

const TrainPreset& trainPreset(const std::string& name) {
  return *std::ranges::find(trainPresets(), name, &TrainPreset::name);
}

uint32_t cellsFor(const TrainPreset& preset, size_t points) {
  constexpr size_t kCellsPerPoint = 2;
  const size_t bound = preset.mostCells;
  return std::max(preset.leastCells, static_cast<uint32_t>(std::min(kCellsPerPoint * points, bound)));
}

}  // namespace froth
