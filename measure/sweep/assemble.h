// From measured points to report.html, report.json and report.csv.
#pragma once

#include <filesystem>
#include <string>

#include "measure/sweep/measure.h"

namespace froth {

struct RunDescription {
  std::string title, input, credit, command;
  bool hasFoam = false, isCpu = false;
};

// Scene, device, sizes, and notes on what was not turned.
void describeRun(const RunDescription& run, const Foam& foam, const Bench& bench, Report& report);

// Points, fronts, what is picked and why, pictures.
Status fillReport(const PointList& points, const Bench& bench, bool hasImages, Report& report);

// Each file to a temporary name, then renamed.
Status writeReport(const std::filesystem::path& folder, const Report& report);

}  // namespace froth
