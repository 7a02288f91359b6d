// How long assets take to open, as a table and as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "measure/opening/opening.h"

namespace froth {

void printOpenings(const Openings& openings, const OpeningOptions& options);
nlohmann::ordered_json openingsAsJson(const Openings& openings, const OpeningOptions& options);

}  // namespace froth
