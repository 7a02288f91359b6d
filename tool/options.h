// Options that several commands share, and checks of their values; messages say what was found and what to give.
#pragma once

#include <cstdint>

#include <CLI/CLI.hpp>

#include "measure/figures.h"
#include "reference/camera/view_selection.h"

namespace froth {

// A finite number in [least, most].
CLI::Validator numberBetween(double least, double most);
// The same in whole numbers, written in digits.
CLI::Validator countBetween(uint64_t least, uint64_t most);

void addViewOptions(CLI::App& command, ViewOptions& options);  // --view, --size
void addLayersOption(CLI::App& command, uint32_t& layers);     // --layers
void addFiguresOption(CLI::App& command, FiguresOutput& output);  // --json

}  // namespace froth
