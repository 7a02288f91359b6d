// Decodes what section_codec_write.h encodes.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/result.h"
#include "format/section.h"
#include "format/section_codec.h"

namespace froth {

// Checks the hash and fills `raw`, whose size must be record.rawSize and whole entries of `shape`. Of the
// record it reads codec and hash alone. Allocates no more than zstd's window and, for the codecs of
// positions, twice raw.size(). Any bytes are safe: they are decoded, or an error names what is wrong. `place`
// names the section in messages.
Status decodeSection(const SectionRecord& record, std::span<const uint8_t> stored, std::span<uint8_t> raw,
                     const std::string& place, SectionShape shape);

}  // namespace froth
