// What a run needs to go on, bit for bit: state.bin.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "trainer/cpu/foam_storage.h"

namespace froth {

struct TrainingState {
  std::vector<double> seconds{0};  // [steps done + 1] Pace::seconds()
  std::string settings;            // text; a run goes on with the same ones alone
  uint32_t photosPerStep = 1;      // a run goes on with as many
  FoamStorage<float> foam;
};

// Atomic: a run that is killed while it saves leaves the file before.
Status writeState(const std::filesystem::path& path, TrainingState& state);
// Checks sizes before memory. Fails with kBadInput for what is no such file, or a part of one.
Result<TrainingState> readState(const std::filesystem::path& path);

}  // namespace froth
