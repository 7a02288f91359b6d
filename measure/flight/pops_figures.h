// How pixels change in a slow dolly, as a table and as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "measure/flight/pops.h"

namespace froth {

void printPops(const Pops& pops, const FlightOptions& options);
nlohmann::ordered_json popsAsJson(const Pops& pops, const FlightOptions& options);

}  // namespace froth
