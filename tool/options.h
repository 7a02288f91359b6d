// Options that several commands share, and checks of their values; messages say what was found and what to give.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "measure/figures.h"
#include "reference/capture/view_selection.h"

namespace froth {

// A finite number in [least, most].
CLI::Validator numberBetween(double least, double most);
// The same in whole numbers, written in digits.
CLI::Validator countBetween(uint64_t least, uint64_t most);

// A duration: a number with its unit, as 500ms, 90s, 5min or 1h, within [least, most] seconds. `seconds` holds the
// default.
CLI::Option* addDurationOption(CLI::App& command, const std::string& name, double& seconds,
                               const std::string& description, double least, double most);

// The names of the runtime's renderers, behind `others`.
std::vector<std::string> methodNames(std::vector<std::string> others = {});

// Of an option whose value readViews() reads.
inline constexpr const char* kCamerasHelp = "The views: cameras.json, a COLMAP folder or transforms.json";

void addViewOptions(CLI::App& command, ViewOptions& options);     // --view, --size
void addLayersOption(CLI::App& command, uint32_t& layers);        // --layers
void addFiguresOption(CLI::App& command, FiguresOutput& output);  // --json

}  // namespace froth
