// `froth stability --search`: hunts for cases that fail, on the CPU and on a device, and keeps what it finds as files.
#pragma once

#include <filesystem>

#include "base/progress_printer.h"
#include "measure/figures.h"
#include "measure/gpu/gpu_renderer.h"
#include "measure/stability/random_search.h"

namespace froth {

struct StabilitySearch {
  double seconds = 0;  // 0: no search
  uint64_t seed = 1;
  std::filesystem::path folder = ".";  // of the files; made
};

// Fails when a case was found. Without a device the CPU judges alone, unless one was asked for by name.
Status runStabilitySearch(const StabilitySearch& search, const GpuDeviceOptions& device, const FiguresOutput& figures,
                          ProgressPrinter& printer);

}  // namespace froth
