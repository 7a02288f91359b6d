// What a flight with streaming showed, as a table and as JSON.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "measure/flight/flight.h"

namespace froth {

// [ms] Nothing, and null, where there are none.
void printFrameTimes(const char* name, const std::vector<double>& times);
nlohmann::ordered_json frameTimesAsJson(const std::vector<double>& times);

// What flights and pops have in common.
nlohmann::ordered_json sceneAsJson(const SceneOptions& scene, const std::string& deviceName,
                                   const std::string& driverName, size_t frames);

void printFlight(const Flight& flight, const FlightOptions& options);
nlohmann::ordered_json flightAsJson(const Flight& flight, const FlightOptions& options);

}  // namespace froth
