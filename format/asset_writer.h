// Writes a .froth asset; in a link target of its own (froth_format_write), so that the runtime carries no writer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "format/asset_contents.h"
#include "format/result.h"

namespace froth {

// The file's bytes. The same contents give the same bytes.
Result<std::vector<uint8_t>> encodeAsset(const AssetContents& contents);

// Encodes, writes to a temporary name beside `path`, syncs, renames: an interrupted write leaves the old file intact.
Status writeAsset(const std::filesystem::path& path, const AssetContents& contents);

}  // namespace froth
