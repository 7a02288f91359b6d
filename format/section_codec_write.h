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

// The shortest of the codecs' encodings; the first of equals. `raw` is a whole number of words.
Result<EncodedSection> encodeSection(std::span<const uint8_t> raw);

}  // namespace froth
