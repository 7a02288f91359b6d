// What is in an asset, for `froth bake` and `froth info`.
#pragma once

#include <nlohmann/json.hpp>

#include "format/asset_contents.h"

namespace froth {

// Chunks need only their origins and counts, as in AssetReader::manifest().
void printStatistics(const AssetContents& contents);
nlohmann::ordered_json statisticsAsJson(const AssetContents& contents);

}  // namespace froth
