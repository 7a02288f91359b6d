// A chunk's arrays from the raw bytes of its sections, which chunk_sections_write.h makes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "base/result.h"
#include "format/chunk_codes.h"
#include "format/read/manifest_read.h"
#include "format/section.h"

namespace froth {

// Fills `raw`, of record.rawSize bytes, with what the section holds.
using SectionDecoder = std::function<Status(const SectionRecord& record, std::span<uint8_t> raw)>;

// Of layers up to `last`; behind it the contents are those of a coarser scene (FORMAT.md, "Layers"). What
// indices and references say is not checked any further than needed to stay within the arrays; checkChunk
// does that. `place` names the chunk.
Result<CodedChunk> unpackChunk(const Manifest& manifest, uint32_t chunk, Layer last, const SectionDecoder& decode,
                               const std::string& place);

}  // namespace froth
