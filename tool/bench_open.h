// froth bench --open: from the opening of an asset to its first image.
#pragma once

#include <cstdint>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "measure/figures.h"
#include "measure/opening/opening.h"
#include "reference/camera/view_selection.h"

namespace froth {

void addOpenOptions(CLI::App& command, OpeningOptions& options);

// Of the first of the views.
Status runOpen(const OpeningOptions& options, const ViewOptions& views, const FiguresOutput& output,
               const Progress& progress);

}  // namespace froth
