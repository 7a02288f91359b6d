// Encodes what section_codec_read.h decodes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/result.h"
#include "format/section.h"

namespace froth {

struct EncodedSection {
  SectionCodec codec = SectionCodec::kStored;
  std::vector<uint8_t> stored;
};

// In a codec that suits the numbers, and never longer than they are. `raw` is whole words, at least one.
Result<EncodedSection> encodeSection(std::span<const uint8_t> raw);

}  // namespace froth
