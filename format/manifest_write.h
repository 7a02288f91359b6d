// The manifest's bytes; manifest_read.h parses them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/asset_contents.h"
#include "format/section.h"

namespace froth {

// The size depends on the number of sections and not on their values.
std::vector<uint8_t> buildManifest(const AssetContents& contents, std::span<const SectionRecord> sections);

}  // namespace froth
