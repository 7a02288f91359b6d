// The manifest's bytes; manifest_read.h parses them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/asset_contents.h"
#include "format/section.h"

namespace froth {

// `contents`: its chunks are not looked at. The size does not depend on the values in `sections`.
std::vector<uint8_t> buildManifest(const AssetContents& contents, std::span<const ChunkIndex> chunks,
                                   std::span<const SectionRecord> sections);

}  // namespace froth
