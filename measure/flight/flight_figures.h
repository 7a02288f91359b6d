// What a flight with streaming showed, as a table and as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "measure/flight/flight.h"

namespace froth {

void printFlight(const Flight& flight, const FlightOptions& options);
nlohmann::ordered_json flightAsJson(const Flight& flight, const FlightOptions& options);

}  // namespace froth
