// `froth stability --search`: hunts for cases that fail, on the CPU and on a device, and keeps what it finds as files.
#pragma once

#include <filesystem>

#include "baker/stability/random_search.h"
#include "baker/tool/commands.h"
#include "baker/tool/figures.h"
#include "baker/tool/gpu_renderer.h"

namespace froth {

struct StabilitySearch {
  double minutes = 0;  // 0: no search
  uint64_t seed = 1;
  std::filesystem::path folder = ".";  // of the files; made
};

// Fails when a case was found. Without a device the CPU judges alone, unless one was asked for by name.
Status runStabilitySearch(const StabilitySearch& search, const GpuDeviceOptions& device, const FiguresOutput& figures, Tool& tool);

}  // namespace froth
