// An asset's arrays as plain bytes, to be compared with what another reader finds (compare_asset.py).
#pragma once

#include <filesystem>

#include "format/asset_contents.h"

namespace froth {

// Each array that is not empty: a line "chunk name bytes", then its bytes.
void writeDump(const std::filesystem::path& path, const AssetContents& contents);

}  // namespace froth
