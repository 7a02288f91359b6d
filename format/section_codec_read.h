// Decodes what section_codec_write.h encodes.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "format/result.h"
#include "format/section.h"

namespace froth {

// Checks the hash and fills `raw`, whose size must be record.rawSize. Allocates no more than zstd's window.
// `place` names the section in messages.
Status decodeSection(const SectionRecord& record, std::span<const uint8_t> stored, std::span<uint8_t> raw,
                     const std::string& place);

}  // namespace froth
