// What is in an asset, for `froth bake` and `froth info`.
#pragma once

#include <nlohmann/json.hpp>

#include "format/asset_contents.h"
#include "format/read/asset_reader.h"

namespace froth {

// Cells are those of level 0. Chunks need only their origins and counts, as in AssetReader::manifest().
void printStatistics(const AssetContents& contents);
nlohmann::ordered_json statisticsAsJson(const AssetContents& contents);

// Bytes per layer and per type of section.
void printSections(const AssetReader& asset);
nlohmann::ordered_json sectionsAsJson(const AssetReader& asset);

// Chunks, cells, bytes and errors of each level of detail, and the floor; nothing, or null, without levels.
void printLevels(const AssetReader& asset);
nlohmann::ordered_json levelsAsJson(const AssetReader& asset);

}  // namespace froth
