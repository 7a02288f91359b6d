// froth bench --flight: a flight with streaming, on a disk as slow as wanted.
#pragma once

#include <cstdint>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "measure/figures.h"
#include "measure/flight/flight.h"
#include "reference/capture/view_selection.h"

namespace froth {

struct FlightFlags {
  FlightOptions flight;
  bool wantsPops = false;  // a slow dolly from the first view, in place of the path
};

void addFlightOptions(CLI::App& command, FlightFlags& flags);

// Along the key frames of the cameras' flight, else through the views.
Status runFlight(const FlightFlags& flags, const ViewOptions& views, const FiguresOutput& output,
                 const Progress& progress);

}  // namespace froth
